"""`friction-bench stop`: everything that this user runs on this machine, or one service by its address."""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.exit_codes import ExitCode, NoAnswerError, ServiceError, StatusError
from bench.cli.operation.service import DEFAULT_URL, ask, ask_with
from bench.cli.output import Json, complain, print_json, say

if TYPE_CHECKING:
    from bench.own_processes import OwnProcess

REASON = "friction-bench stop"
POWER_OFF_S = 3.0  # the drive brakes for half a second at most, then the record is closed
_POLL_S = 0.01
NOT_FOUND = 404
StoppedUrl = Annotated[
    str | None,
    typer.Option(envvar="FRICTION_BENCH_URL", help="Address of one service; without it all that this user runs here."),
]


class Answered(NamedTuple):
    """What came of one that was asked.

    Attributes:
        who: the service or the command, with its bench.
        was_running: whether it moved a joint; None where it was not reached.
    """

    who: str
    detail: str
    was_running: bool | None


def stop(context: typer.Context, url: StoppedUrl = None, as_json: Json = False) -> None:
    """Stop every joint that this user moves on this machine, and power it off; with --url that of one service.

    Asks every service and every command that runs experiments, and says of each what came of it. Ends with 5 where one
    was not reached.
    """
    session = session_of(context)
    if url is not None:
        found = ask(session, "POST", url, "/stop", {"reason": REASON})
        print_json(found) if as_json else say(f"{url}: {found['detail']}")
        return
    answers = stop_all(session)
    if not answers:
        raise ServiceError(
            f"nothing was stopped: this user runs no service and no experiment on this machine, and {DEFAULT_URL} does "
            "not answer; stop another user's service, or another machine's, with --url"
        )
    if as_json:
        print_json([one._asdict() for one in answers])
    for one in answers:
        if one.was_running is None:
            complain(f"{one.who} WAS NOT STOPPED: {one.detail}")
        elif not as_json:
            say(f"{one.who}: {one.detail}")
    if any(one.was_running is None for one in answers):
        raise typer.Exit(ExitCode.SERVICE)


def stop_all(session: BenchSession) -> list[Answered]:
    """Ask all at once; the commands first, which takes no time."""
    from bench.own_processes import own_processes

    processes = own_processes()
    waits = [_ask_command(path, told) for path, told in processes if not told.url]
    services = [(path, told) for path, told in processes if told.url]
    asked: list[Callable[[], Answered | None]] = [partial(_ask_service, *one) for one in services]
    if all(told.url != DEFAULT_URL for _, told in services):
        asked.append(partial(_ask_default, session))
    with ThreadPoolExecutor(len(asked) + 1) as pool:
        answers = list(pool.map(lambda one: one(), asked))
    return [wait() for wait in waits] + [one for one in answers if one is not None]


def _ask_command(path: Path, told: "OwnProcess") -> Callable[[], Answered]:
    """Have a command stop; returns what waits for it."""
    from bench.runs.stoppable import ask_to_stop, moves

    was_running = moves(path)
    try:
        ask_to_stop(path, REASON)
    except OSError as error:
        failed = f"its stop line cannot be opened ({error.strerror}); press Ctrl-C in its terminal"
        return lambda: _unless_over(path, Answered(told.title, failed, None))

    def wait() -> Answered:
        deadline_s = time.monotonic() + POWER_OFF_S
        while moves(path):
            if time.monotonic() > deadline_s:
                late = f"it was told to, and still runs after {POWER_OFF_S:g} s; press Ctrl-C in its terminal"
                return Answered(told.title, late, None)
            time.sleep(_POLL_S)
        if was_running:
            return Answered(told.title, "stopped; its terminal and its record say how it ended.", True)
        return Answered(told.title, "nothing was moving; it will not start anything more.", False)

    return wait


def _ask_service(path: Path, told: "OwnProcess") -> Answered:
    from bench.trust import trusted, trusted_alone

    trust = trusted_alone(told.certificate) if told.certificate else trusted(told.url)
    try:
        found = ask_with(told.token, trust, "POST", told.url, "/stop", {"reason": REASON})
    except ServiceError as error:
        return _unless_over(path, Answered(told.title, f"{error}; press Ctrl-C in its terminal", None))
    return _as_said(told.title, found)


def _ask_default(session: BenchSession) -> Answered | None:
    """The service at the usual address, whoever runs it; None where there is none."""
    try:
        found = ask(session, "POST", DEFAULT_URL, "/stop", {"reason": REASON})
    except NoAnswerError:
        return None
    except StatusError as error:
        if error.status == NOT_FOUND:
            return None  # a program of another kind
        return Answered(f"{DEFAULT_URL}, which this user does not run,", str(error), None)
    return _as_said(DEFAULT_URL, found)


def _as_said(who: str, found: Any) -> Answered:
    return Answered(who, str(found["detail"]), bool(found["was_running"]))


def _unless_over(path: Path, failed: Answered) -> Answered:
    """A failure, unless the process has ended meanwhile: it powers off first."""
    from bench.own_processes import lives

    return failed if lives(path) else Answered(failed.who, "it has just ended.", False)
