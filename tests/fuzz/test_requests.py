"""Requests spoilt byte by byte, in path, query and body: no answer is a fault of the server's."""

import http.client
import socket
from random import Random
from typing import Any, NamedTuple
from urllib.parse import urlsplit

import pytest
import requests
from hypothesis import given
from schemathesis import GenerationMode

from tests.fuzz.asking import ANSWERS, HEADERS, LONGEST_S, described, stand_still
from tests.fuzz.edits import spoilt_by
from tests.fuzz.effort import TIMES, effort
from tests.service.running_service import RunningService

REQUESTS, OF_EACH = 2000, 4
PARTS = 8  # of the run: each by itself, so that several processes share it


class Sent(NamedTuple):
    """What goes over the line."""

    method: str
    target: bytes
    kind: bytes
    body: bytes

    def spoilt(self, chance: Random) -> "Sent":
        """The same, with its target or its body spoilt."""
        if self.body and chance.random() < 0.7:
            return self._replace(body=spoilt_by(chance, self.body))
        start = self.target.find(b"?") + 1 or len(b"/api/v1/")
        # what would end the line is no part of a target: it is another request
        rest = bytes(one for one in spoilt_by(chance, self.target[start:]) if one > 0x20)
        return self._replace(target=self.target[:start] + rest)

    def on_line(self) -> bytes:
        """The bytes."""
        lines = (
            self.method.encode() + b" " + self.target + b" HTTP/1.1", b"Host: localhost",
            b"Authorization: " + HEADERS["Authorization"].encode(), b"Content-Type: " + self.kind,
            b"Content-Length: %d" % len(self.body), b"", self.body,
        )  # fmt: skip
        return b"\r\n".join(lines)


class Line:
    """A connection, made anew where the service has ended it."""

    def __init__(self, url: str) -> None:
        self._address = urlsplit(url).hostname, urlsplit(url).port
        self._socket: socket.socket | None = None

    def ask(self, sent: Sent) -> int:
        """The status of the answer."""
        self._socket = self._socket or socket.create_connection(self._address, timeout=LONGEST_S)
        self._socket.sendall(sent.on_line())
        answer = http.client.HTTPResponse(self._socket, method=sent.method)
        answer.begin()
        is_stream = (answer.headers.get("Content-Type") or "").startswith("text/event-stream")
        if not is_stream:  # that has no end: a path may be spoilt to /live
            answer.read()
        if is_stream or answer.will_close:
            self.close()
        return answer.status

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
        self._socket = None


@pytest.fixture(scope="module")
def sound(recorded: RunningService) -> list[Sent]:
    """Some requests of each route, as its description has them."""
    found: list[Sent] = []

    def keep(case: Any) -> None:
        words = case.as_transport_kwargs(headers=HEADERS)
        request = requests.Request(**words).prepare()
        body = request.body.encode() if isinstance(request.body, str) else request.body or b""
        kind = request.headers.get("Content-Type", "application/json")
        found.append(Sent(str(request.method), str(request.path_url).encode(), str(kind).encode(), body))

    for operation in described(recorded).get_all_operations():
        cases = operation.ok().as_strategy(generation_mode=GenerationMode.POSITIVE)
        effort(OF_EACH, 1)(given(case=cases)(keep))()
    return found


@pytest.mark.parametrize("part", range(PARTS))
def test_no_answer_is_a_fault_of_the_servers(recorded: RunningService, sound: list[Sent], part: int) -> None:
    chance, line = Random(f"{part} of {TIMES}"), Line(recorded.url)
    for _ in range(REQUESTS * TIMES // PARTS):
        sent = chance.choice(sound).spoilt(chance)
        status = line.ask(sent)
        ANSWERS[f"{status // 100}xx"] += 1
        assert status < 500, sent
        if status < 300 and sent.method != "GET":
            stand_still(recorded)
    line.close()
    stand_still(recorded)
