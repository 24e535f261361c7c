"""Connections that say nothing, or do not read: closed, so that STOP always comes in."""

import resource
import socket
import time
from contextlib import ExitStack, suppress

import httpx
import pytest

from bench.service.http import connections
from bench.service.http.page import plotly_file
from tests.service.plain_http import NOBODY
from tests.service.running_service import TOKEN, running_service
from tests.service.served_process import started_process

FEW_FILES = 200


def connected(url, sent=b""):
    host = httpx.URL(url).host
    connection = socket.create_connection((host, httpx.URL(url).port), timeout=5.0)
    connection.sendall(sent)
    return connection


def is_closed_within(connection, within_s):
    connection.settimeout(within_s)
    try:
        return connection.recv(1000) == b""
    except ConnectionResetError:
        return True
    except TimeoutError:
        return False


@pytest.mark.parametrize("sent", [b"", b"GET /api/v1/bench HTTP/1.1\r\nHost: "], ids=["nothing", "half a head"])
def test_a_connection_without_a_request_is_closed(tmp_path, monkeypatch, sent):
    monkeypatch.setattr(connections, "HEAD_S", 0.3)
    with running_service(tmp_path) as service, connected(service.url, sent) as connection:
        assert is_closed_within(connection, 5.0)


def test_a_head_that_trickles_has_its_time_once(tmp_path, monkeypatch):
    monkeypatch.setattr(connections, "HEAD_S", 0.5)
    with running_service(tmp_path) as service, connected(service.url) as connection:
        for _ in range(40):
            with suppress(ConnectionError):
                connection.sendall(b"G")
            time.sleep(0.05)
        assert is_closed_within(connection, 0.1)


def test_one_that_asks_again_after_half_a_head_is_served(tmp_path):
    head = b"GET /api/v1/bench HTTP/1.1\r\nHost: localhost\r\n\r\n"
    with running_service(tmp_path) as service, connected(service.url, head[:20]) as connection:
        time.sleep(0.1)
        connection.sendall(head[20:])
        assert connection.recv(1000).startswith(b"HTTP/1.1 200")
        connection.sendall(head)
        assert connection.recv(1000)


def test_an_answer_that_nobody_reads_is_given_up(tmp_path, monkeypatch):
    monkeypatch.setattr(connections, "UNREAD_S", 0.3)
    with running_service(tmp_path) as service, socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect((httpx.URL(service.url).host, httpx.URL(service.url).port))
        connection.settimeout(5.0)
        connection.sendall(b"GET /static/plotly.min.js HTTP/1.1\r\nHost: localhost\r\n\r\n")
        time.sleep(1.5)
        got = 0
        with suppress(ConnectionError):
            while more := connection.recv(2**16):
                got += len(more)
        assert got < plotly_file().stat().st_size


LISTEN = b"GET /api/v1/live HTTP/1.1\r\nHost: localhost\r\n\r\n"


@pytest.mark.parametrize("sent", [b"", LISTEN], ids=["silent", "listening"])
def test_stop_is_heard_beside_more_connections_than_a_process_may_have_files(tmp_path, sent):
    headers = {"Authorization": f"Bearer {TOKEN}"}
    with started_process(tmp_path) as (process, url), ExitStack() as many:
        resource.prlimit(process.pid, resource.RLIMIT_NOFILE, (FEW_FILES, FEW_FILES))
        for _ in range(2 * FEW_FILES):
            many.enter_context(connected(url, sent))
        answer = httpx.post(f"{url}/api/v1/stop", headers=headers, timeout=5.0, verify=NOBODY)
        assert answer.status_code == 200
