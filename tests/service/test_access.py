"""Who may do what."""

import re
import socket
from collections import OrderedDict

import httpx
import pytest

from bench.errors import ConfigurationError
from bench.service.auth.access import check_bind
from bench.service.server import Address, listen
from tests.service.running_service import TOKEN, running_service

CHANGES = [
    ("POST", "/experiments"),
    ("POST", "/experiments/plan"),
    ("POST", "/stop"),
    ("POST", "/continue"),
    ("POST", "/drive/state"),
    ("POST", "/drive/clear-fault"),
    ("POST", "/lease"),
    ("PUT", "/lease"),
    ("DELETE", "/lease"),
    ("PATCH", "/experiments/1"),
    ("POST", "/queue"),
    ("DELETE", "/queue"),
    ("PATCH", "/queue/1"),
    ("DELETE", "/queue/1"),
    ("POST", "/queue/pause"),
    ("POST", "/queue/resume"),
    ("POST", "/benches/queue"),
    ("DELETE", "/benches/queue/1"),
    ("POST", "/campaigns"),
    ("POST", "/campaigns/plan"),
    ("POST", "/recording-sets?name=x"),
    ("POST", "/recording-sets/guess?name=x"),
    ("POST", "/calibrations"),
    ("POST", "/calibrations/1/use"),
    ("DELETE", "/calibrations/in-use"),
    ("POST", "/studies"),
    ("POST", "/studies/check"),
    ("POST", "/studies/1/models"),
    ("POST", "/studies/1/search"),
    ("POST", "/studies/1/use"),
    ("POST", "/studies/1/trials"),
    ("POST", "/studies/1/suggest"),
    ("POST", "/studies/1/rounds"),
    ("POST", "/studies/1/use"),
    ("POST", "/challenges"),
    ("POST", "/challenges/1/reveal"),
    ("DELETE", "/studies/1/models/1"),
    ("DELETE", "/experiments/1"),
    ("DELETE", "/studies/1"),
    ("POST", "/calibrations/run"),
    ("POST", "/calibrations/run/pause"),
    ("POST", "/calibrations/run/resume"),
    ("POST", "/commission"),
    ("POST", "/commission/answer"),
    ("POST", "/challenges"),
    ("POST", "/challenges/1/reveal"),
]


@pytest.mark.parametrize(("method", "path"), CHANGES)
def test_a_change_without_token_is_refused(service, method, path):
    answer = service.stranger.request(method, path, json={"kind": "steps"})
    assert answer.status_code == 401
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["www-authenticate"] == "Bearer"
    assert "friction-bench serve" in answer.json()["detail"]


def test_every_route_that_changes_state_is_in_the_list_above(service):
    paths = service.client.get("/openapi.json").json()["paths"]
    found = {(method.upper(), path) for path, item in paths.items() for method in item if method not in {"get"}}
    listed = {(method, path.partition("?")[0]) for method, path in CHANGES}
    templates = {(method, re.sub(r"\{\w+_id\}", "1", path.replace("/api/v1", ""))) for method, path in found}
    assert templates == listed


@pytest.mark.parametrize("wrong", ["x", TOKEN[:-1], TOKEN + "x", "ü" * 20])
def test_a_wrong_token_is_refused(service, wrong, monkeypatch):
    monkeypatch.setattr(service.access.attempts, "_full_at_s", OrderedDict())
    header = b"Bearer " + wrong.encode()
    assert service.stranger.post("/stop", headers={"Authorization": header}).status_code == 401


def test_the_token_is_not_taken_from_the_address(service):
    assert service.stranger.post(f"/stop?token={TOKEN}&access_token={TOKEN}").status_code == 401


def test_reading_is_open_on_loopback(service):
    assert service.stranger.get("/bench").status_code == 200


def test_reading_beyond_loopback_needs_the_token(tmp_path):
    with running_service(tmp_path, reads_open=False) as closed:
        for path in ("/bench", "/trials", "/experiments", "/live/now", "/effects", "/studies", "/experiment-kinds"):
            assert closed.stranger.get(path).status_code == 401, path
        assert closed.client.get("/bench").status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8000", "127.0.0.1.evil.example", ""])
def test_a_foreign_host_name_is_refused(service, host):
    answer = service.client.get("/bench", headers={"Host": host})
    assert answer.status_code == 421
    assert "--allow-host" in answer.json()["detail"]


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "https://evil.example"},
        {"Origin": "null"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_a_foreign_page_cannot_move_the_machine(service, headers):
    assert service.client.post("/experiments", json={"kind": "steps"}, headers=headers).status_code == 403
    assert service.client.post("/stop", headers=headers).status_code == 403


@pytest.mark.parametrize("mode", [{}, {"Sec-Fetch-Mode": "no-cors"}, {"Sec-Fetch-Mode": "navigate"}])
def test_a_foreign_page_cannot_read_either(service, mode):
    inside = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Dest": "iframe", **mode}
    for path in ("/bench", "/live", "/experiments/1/recording-set", "/nothing"):
        answer = service.client.get(path, headers=inside)
        assert (answer.status_code, "only a page of this service may" in answer.text) == (403, True)
    link = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert service.client.get("/bench", headers=link).status_code == 200
    assert httpx.get(service.url + "/", headers=link).status_code == 200


def test_our_own_page_can(service):
    assert (
        service.client.post("/stop", headers={"Origin": service.url, "Sec-Fetch-Site": "same-origin"}).status_code
        == 200
    )


def test_nothing_foreign_runs_in_the_page(service):
    for path in ("/", "/static/modules/app/main.js", "/static/plotly.min.js", "/api/v1/bench"):
        policy = httpx.get(service.url + path).headers["content-security-policy"]
        assert "script-src 'self';" in policy
        assert "unsafe-inline" not in policy
        assert "unsafe-eval" not in policy


def test_a_foreign_host_does_not_even_get_the_page(service):
    assert httpx.get(service.url, headers={"Host": "evil.example"}).status_code == 421


def test_listening_beyond_loopback_takes_a_token():
    for host in ("127.0.0.1", "::1", "localhost", "127.0.0.2"):
        check_bind(host, token_configured=False)
    check_bind("0.0.0.0", token_configured=True)
    for host in ("0.0.0.0", "::", "192.168.1.5", "bench.lab"):
        with pytest.raises(ConfigurationError, match="token new NAME --role admin; or set FRICTION_BENCH_TOKEN"):
            check_bind(host, token_configured=False)


def test_no_answer_waits_for_word_of_its_first_piece():
    """Nagle's algorithm and a client's delayed acknowledgement together cost 40 ms on each connection that is kept."""
    with (
        listen(Address("127.0.0.1", 0)) as listener,
        socket.create_connection(listener.getsockname()),
        listener.accept()[0] as accepted,
    ):
        assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
