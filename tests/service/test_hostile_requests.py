"""Requests that no well-meaning program sends: answered as problems, and STOP works all the same."""

import socket
from urllib.parse import urlsplit

import pytest

from tests.service.running_service import TOKEN

LONE_SURROGATE = b'"\\ud800"'


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/experiments", b'{"kind": ' + LONE_SURROGATE + b"}"),
        ("/experiments", b'{"kind": "steps", "note": ' + LONE_SURROGATE + b"}"),
        ("/experiments", b'{"kind": "steps", "parameters": {' + LONE_SURROGATE + b": 1}}"),
        ("/experiments", b'{"kind": "steps", "parameters": {"load_kg": NaN}}'),
        ("/experiments", b'{"kind": "steps", "parameters": {"load_kg": 1e999}}'),
        ("/studies", b'{"name": ' + LONE_SURROGATE + b', "experiment_ids": [1]}'),
        ("/studies", b'{"name": "x", "experiment_ids": [99999999999999999999]}'),
    ],
)
def test_what_cannot_be_kept_is_refused(idle, path, body):
    answer = idle.client.post(path, content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert idle.runner.status().outcome != "running"


def test_a_number_beyond_the_database_is_a_problem(service):
    assert service.stranger.get("/experiments/99999999999999999999").status_code == 422


def test_a_body_that_is_no_json_is_told_where(service):
    answer = service.client.post("/experiments", content=b"[", headers={"Content-Type": "application/json"})
    assert "the body is no JSON: Expecting value, at character 1" in answer.json()["detail"]


@pytest.mark.parametrize("sent", [{}, {"Content-Type": "application/x-www-form-urlencoded"}])
def test_a_body_that_is_not_called_json_names_the_header(service, sent):
    answer = service.client.post("/experiments", content=b'{"kind": "steps"}', headers=sent)
    assert answer.status_code == 422
    assert "send 'Content-Type: application/json'" in answer.json()["detail"]
    assert (sent.get("Content-Type") or "no Content-Type") in answer.json()["detail"]


@pytest.mark.parametrize(("method", "path", "status"), [("GET", "/nothing", 404), ("PUT", "/stop", 405)])
def test_a_route_that_is_none_leads_to_those_there_are(service, method, path, status):
    answer = service.client.request(method, path)
    assert answer.status_code == status
    assert f"there is no {method} /api/v1{path}; GET /api/v1/openapi.json" in answer.json()["detail"]
    assert service.stranger.get("/openapi.json").status_code == 200


def test_a_body_in_another_encoding_is_a_problem(service):
    for sent in (b'{"kind": "\xff"}', '{"kind": "st\u00e9ps"}'.encode("latin-1"), '{"kind": "steps"}'.encode("cp037")):
        answer = service.client.post("/experiments", content=sent, headers={"Content-Type": "application/json"})
        assert answer.status_code == 422, sent
        assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("body", [b"[", b'{"reason": 5}', b'{"reason": "\\ud800"}', b"\xff", b"x" * 100_000])
def test_stop_works_whatever_its_body_is(idle, body):
    idle.start("steps", pace="real-time", repeats=3)
    answer = idle.client.post("/stop", content=body, headers={"Content-Type": "application/json"})
    assert answer.json()["was_running"] is True
    assert idle.runner.wait(5.0)
    assert idle.runner.status().outcome == "stopped"


def test_stop_does_not_wait_for_a_body_that_never_comes(idle):
    idle.start("steps", pace="real-time", repeats=3)
    address = urlsplit(idle.url)
    head = (
        f"POST /api/v1/stop HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {TOKEN}\r\nContent-Length: 9\r\n\r\n"
    )
    with socket.create_connection((address.hostname, address.port)) as connection:
        connection.sendall(head.encode())
        assert idle.runner.wait(5.0)
    assert idle.runner.status().outcome == "stopped"


def test_addresses_that_cannot_be_parsed_are_refused(service):
    assert service.stranger.get("/bench", headers={"Host": "["}).status_code == 421
    assert service.client.post("/stop", headers={"Origin": "http://["}).status_code == 403


def test_a_name_longer_than_file_systems_allow_names_the_problem_of_the_set(service):
    headers = {"Content-Type": "application/zip"}
    answer = service.client.post("/recording-sets", params={"name": "😀" * 100}, content=b"no zip", headers=headers)
    assert answer.status_code == 422
    assert "is no zip" in answer.json()["detail"]


def test_a_stretch_that_ends_before_it_begins_is_told_so(idle):
    trial = idle.store.trials(idle.run("steps", repeats=1)["experiment_id"])[0].id
    for from_s, to_s in (("1e308", "-1e308"), ("2", "1")):
        answer = idle.stranger.get(f"/trials/{trial}/samples", params={"from_s": from_s, "to_s": to_s})
        assert (answer.status_code, "beyond to_s" in answer.json()["detail"]) == (422, True)
    for from_s, to_s in (("1", "1"), ("1e308", "1e308"), ("-5", "-4")):
        answer = idle.stranger.get(f"/trials/{trial}/samples", params={"from_s": from_s, "to_s": to_s})
        assert answer.status_code == 200, answer.text


def test_where_the_store_is_kept_is_told_to_those_with_a_token_alone(service):
    place = service.store.where
    assert place.startswith("/")
    for path in ("/trials/99999999999999999999", "/experiments/99999999999999999999", "/studies/99999999999999999999"):
        answer = service.stranger.get(path)
        assert (answer.status_code, place in answer.text) == (422, False)
        assert "store of this service: " in answer.json()["detail"]


def test_stop_with_a_stroke_at_its_end_stops(idle):
    idle.start("steps", pace="real-time", repeats=50)
    assert idle.stranger.post("/stop/").status_code == 401
    answer = idle.client.post("/stop/", json={"reason": "hand in the joint"})
    assert (answer.status_code, answer.json()["was_running"]) == (200, True)
    assert idle.runner.wait(10.0)
    assert idle.runner.status().reason.endswith("hand in the joint")
