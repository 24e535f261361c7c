"""Requests and answers; refusals of the service as exceptions."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import httpx

from bench.client.errors import Refused, Unreachable
from bench.trust import trusted

TRIES = 3
PAUSE_S = 0.5
PAGE = 1000


class Connection:
    """One service. Used from any thread.

    Args:
        url: of the service, "http://127.0.0.1:8000".
        token: None: only what is open.
        timeout_s: for an answer [s]; a diagnosis takes seconds, a search more.
        ca_file: certificate, in PEM, that vouches for the service; None: those of the system.
    """

    def __init__(self, url: str, token: str | None, timeout_s: float, ca_file: str | None) -> None:
        self.url = url.rstrip("/")
        headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        trust = trusted(self.url, ca_file)
        self._http = httpx.Client(base_url=f"{self.url}/api/v1", headers=headers, timeout=timeout_s, verify=trust)

    def close(self) -> None:
        """Let go of the service."""
        self._http.close()

    def get(self, path: str, **query: Any) -> Any:
        """JSON; asked for again where the service did not answer.

        Raises:
            Unreachable, Refused
        """
        return self._repeated("GET", path, params=_given(query)).json()

    def text(self, path: str, **query: Any) -> str:
        """Text, as `get`."""
        return self._repeated("GET", path, params=_given(query)).text

    def post(self, path: str, body: Mapping[str, object] | None = None, key: str | None = None) -> Any:
        """JSON. With an idempotency key it is sent again where no answer came; else never.

        Raises:
            Unreachable, Refused
        """
        if key is not None:
            return self._repeated("POST", path, json=body, headers={"Idempotency-Key": key}).json()
        return self._once("POST", path, json=body).json()

    def send(self, method: str, path: str, body: Mapping[str, object] | None = None, **query: Any) -> None:
        """Something whose answer does not matter.

        Raises:
            Unreachable, Refused
        """
        self._once(method, path, json=body, params=_given(query))

    def items(self, path: str, **query: Any) -> Iterator[dict[str, Any]]:
        """All items of a list, page after page."""
        offset: int | None = 0
        while offset is not None:
            page = self.get(path, **query, limit=PAGE, offset=offset)
            yield from page["items"]
            offset = page["next_offset"]

    @contextmanager
    def stream(self, path: str, headers: dict[str, str]) -> Iterator[Iterator[str]]:
        """Lines of an answer that does not end; a service is silent for half a second at most.

        Raises:
            Unreachable, Refused
        """
        try:
            with self._http.stream("GET", path, headers=headers) as answer:
                if answer.is_error:
                    answer.read()
                yield _checked(answer).iter_lines()
        except httpx.HTTPError as error:
            raise self._unreachable(error) from error

    def _repeated(self, method: str, path: str, **how: Any) -> httpx.Response:
        for _ in range(TRIES - 1):
            try:
                return self._once(method, path, **how)
            except Unreachable:
                time.sleep(PAUSE_S)
        return self._once(method, path, **how)

    def _once(self, method: str, path: str, **how: Any) -> httpx.Response:
        try:
            return _checked(self._http.request(method, path, **how))
        except httpx.HTTPError as error:
            raise self._unreachable(error) from error

    def _unreachable(self, error: httpx.HTTPError) -> Unreachable:
        told = str(error) or type(error).__name__
        return Unreachable(f"{self.url} does not answer ({told}); is 'friction-bench serve' running there?")


def _checked(answer: httpx.Response) -> httpx.Response:
    if not answer.is_error:
        return answer
    try:
        problem = answer.json()
        detail, kind, errors = str(problem["detail"]), str(problem["kind"]), list(problem["errors"])
    except (ValueError, KeyError, TypeError):
        detail, kind, errors = f"the service answered {answer.status_code} {answer.reason_phrase}", "", []
    raise Refused(answer.status_code, detail, kind, errors)


def _given(query: Mapping[str, object]) -> dict[str, Any]:
    return {name: value for name, value in query.items() if value is not None}
