"""What a start would move is said before anything moves."""

import pytest


def plan(service, kind, **parameters):
    return service.client.post("/experiments/plan", json={"kind": kind, "parameters": parameters})


def test_what_a_start_would_move_is_said_and_nothing_is_recorded(service):
    before = service.client.get("/experiments").json()["items"]
    told = plan(service, "steps", repeats=4, angle_rad=1.2, load_kg=0.05).json()
    assert told["trials"] == 4
    assert told["angles_rad"] == [1.2, 1.2]
    assert told["position_limits_rad"] == [-2.2, 2.2]
    assert told["loads_kg"] == [0.05]
    assert 0.5 <= told["speed_rad_s"] <= 4.0
    assert told["duration_s"] > 1.0
    assert service.client.get("/experiments").json()["items"] == before


@pytest.mark.parametrize(
    ("kind", "parameters", "field", "words"),
    [
        ("steps", {"load_kg": 5}, "parameters.load_kg", "at most 0.1 kg"),
        ("steps", {"angle_rad": 90}, "parameters.angle_rad", "Are degrees meant?"),
        ("load-sweep", {"loads_kg": [0.05, 3]}, "parameters.loads_kg", "at most 0.1 kg"),
        ("steps", {"repeats": "many"}, "parameters.repeats", "integer"),
    ],
)
def test_what_the_bench_refuses_is_said_at_its_field(service, kind, parameters, field, words):
    answer = plan(service, kind, **parameters)
    assert answer.status_code == 422
    (problem,) = answer.json()["errors"]
    assert problem["field"] == field
    assert words in problem["message"]


def test_a_typing_error_leaves_no_record_and_a_refusal_does(service):
    def count():
        return len(service.client.get("/experiments").json()["items"])

    before = count()
    body = {"kind": "steps", "parameters": {"repeats": "many"}}
    assert service.client.post("/experiments", json=body).status_code == 422
    assert count() == before
    assert service.client.post("/experiments", json={**body, "parameters": {"load_kg": 5}}).status_code == 422
    assert count() == before + 1
