"""`friction-bench status`: a service that is running, by its address; and how any command asks one."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.exit_codes import NoAnswerError, ServiceError, StatusError
from bench.cli.output import Json, print_json, table

if TYPE_CHECKING:
    import ssl

    import httpx

TIMEOUT_S = 5.0
Url = Annotated[str, typer.Option(envvar="FRICTION_BENCH_URL", help="Address of the service.")]
DEFAULT_URL = "http://127.0.0.1:8000"


def status(context: typer.Context, url: Url = DEFAULT_URL, as_json: Json = False) -> None:
    """Show what a running service's bench is doing."""
    found = ask(session_of(context), "GET", url, "/bench")
    if as_json:
        print_json(found)
        return
    run = found["run"] or {}
    facts = {"bench": found["name"], "drive": "simulated" if found["simulated"] else "real", "state": found["state"]}
    facts |= {
        name: run[name]
        for name in ("kind", "experiment_id", "outcome", "reason", "progress", "left_s", "pausing")
        if name in run
    }
    table(url, ["what", "value"], facts.items())


def ask(session: BenchSession, method: str, url: str, path: str, body: Mapping[str, object] | None = None) -> Any:
    """What a service answers; None where it answers nothing.

    Raises:
        NoAnswerError: it cannot be reached.
        ServiceError: it refuses, or says no.
    """
    from bench.trust import trusted

    return ask_with(token_for(session, url), trusted(url), method, url, path, body)


def ask_with(
    token: str | None,
    trust: "ssl.SSLContext | bool",
    method: str,
    url: str,
    path: str,
    body: Mapping[str, object] | None = None,
) -> Any:
    """As `ask`, with a token and with certificates that are known."""
    import httpx  # here: its import takes longer than most commands

    headers = {} if token is None else {"Authorization": f"Bearer {token}"}
    whole = f"{url}/api/v1{path}"
    try:
        answer = httpx.request(method, whole, json=body, headers=headers, timeout=TIMEOUT_S, verify=trust)
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        raise NoAnswerError(f"{url} does not answer ({error}); is 'friction-bench serve' running there?") from error
    if answer.is_error:
        raise StatusError(f"{url} answered {answer.status_code}: {_detail(answer)}", answer.status_code)
    return answer.json() if answer.content else None


def token_for(session: BenchSession, url: str) -> str | None:
    """The token for a service: one that was chosen, else that of the same user's service on this machine."""
    from bench.own_service import local_port
    from bench.service.auth.session import found_token
    from bench.service.auth.tokens import chosen_token, token_file

    chosen = chosen_token(token_file(session.store_url()))
    if chosen is not None:
        return chosen[1]
    try:
        port = local_port(url)
    except ValueError as error:
        raise ServiceError(f"'{url}' is no address of a service ({error}); wanted is {DEFAULT_URL}") from error
    return None if port is None else found_token(session.store_url(), port)


def _detail(answer: "httpx.Response") -> str:
    try:
        return str(answer.json()["detail"])
    except (ValueError, KeyError, TypeError):
        return answer.reason_phrase
