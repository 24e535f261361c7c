"""What a start would move is said before anything moves."""

import pytest

from bench.errors import LimitError, quantity_message
from bench.experiments.registry import find_kind
from bench.service.http.problems import InvalidFieldsError
from bench.service.routes.refused_fields import told_at_its_fields


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


@pytest.mark.parametrize(
    ("kind", "parameters", "words"),
    [
        ("load-sweep", {"loads_kg": [0.0] * 201}, "has 201 values; allowed are 200"),
        ("load-sweep", {"loads_kg": [0.0] * 200, "angles_rad": [0.0] * 200}, "make 40000 trials; allowed are 5000"),
        ("excitation", {"loads_kg": [0.0] * 200, "repeats": 100}, "allowed are 5000"),
        ("breakaway-ramps", {"rates_a_s": [1.0] * 60, "dwells_s": [1.0] * 100}, "make 6000 trials"),
        ("hold-and-soak", {"soak_s": 86_400, "probe_every_s": 1}, "make 172801 trials"),
        ("multisine", {"wave_s": 600, "waves": 1000}, "at most 7200 s"),
        ("breakaway-ramps", {"slip_speed_rad_s": 5e-324}, "at least 2.2"),
        ("multisine", {"wave_s": 5e-324}, "at least 2.2"),
    ],
)
def test_what_nobody_records_is_not_planned(service, kind, parameters, words):
    answer = plan(service, kind, **parameters)
    assert (answer.status_code, words in answer.text) == (422, True), answer.text


@pytest.mark.parametrize("path", ["/experiments/plan", "/experiments"])
@pytest.mark.parametrize(
    ("kind", "parameters", "field", "found", "allowed", "unit"),
    [
        ("steps", {"angle_rad": 8.72665}, "angle_rad", 8.72665, {"ge": -2.05, "le": 2.05, "margin": 0.15}, "rad"),
        ("steps", {"load_kg": 5}, "load_kg", 5, {"le": 0.1}, "kg"),
        ("steps", {"fastest_rad_s": 9}, "fastest_rad_s", 9, {"le": 8}, "rad/s"),
        ("load-sweep", {"angles_rad": [-3]}, "angles_rad", -3, {"ge": -2.05, "le": 2.05, "margin": 0.15}, "rad"),
        ("steady-speeds", {"speeds_rad_s": [20]}, "speeds_rad_s", 20, {"le": 8}, "rad/s"),
        # of a speed and a tenth, the value found is not the one that was asked for
        ("speed-sweep", {"speeds_rad_s": [7.9]}, "speeds_rad_s", None, {}, ""),
    ],
)
def test_a_limit_of_the_bench_is_told_with_its_numbers(idle, path, kind, parameters, field, found, allowed, unit):
    answer = idle.client.post(path, json={"kind": kind, "parameters": parameters})
    assert answer.status_code == 422
    assert answer.json()["kind"] == "LimitError"
    (problem,) = answer.json()["errors"]
    assert problem["field"] == f"parameters.{field}"
    assert (problem["found"], problem["allowed"], problem["unit"]) == (found, pytest.approx(allowed), unit)


def test_a_limit_of_the_configuration_is_no_field_of_the_form(service):
    kind = find_kind("excitation")
    message = quantity_message("motion.speed_rad_s", 9.0, "at most 8", "rad/s")
    with pytest.raises(InvalidFieldsError) as caught, told_at_its_fields(kind):
        raise LimitError(message)
    assert "speed_rad_s" in kind.parameters.model_fields
    assert caught.value.errors == []


def test_a_typing_error_leaves_no_record_and_a_refusal_does(service):
    def count():
        return len(service.client.get("/experiments").json()["items"])

    before = count()
    body = {"kind": "steps", "parameters": {"repeats": "many"}}
    assert service.client.post("/experiments", json=body).status_code == 422
    assert count() == before
    assert service.client.post("/experiments", json={**body, "parameters": {"load_kg": 5}}).status_code == 422
    assert count() == before + 1
