"""Commissioning over REST: questions and answers, ended by STOP; what it moves is in tests/commission."""

import time
import tomllib

import pytest

from bench.commission.evidence import Finding
from bench.config.configuration import parse_configuration
from tests.commission.scripted import scripted_service
from tests.queue.waiting import wait_for

ANSWERS = [0.25, 50.0, None, 3.0, 0.1, None, 90.0, None, 0.05]


@pytest.fixture
def joint(tmp_path):
    with scripted_service(tmp_path) as running:
        yield running


def now(service):
    return service.client.get("/commission").json()


def asked(service):
    """The question that is open, once it is."""
    deadline_s = time.monotonic() + 20.0
    while time.monotonic() < deadline_s:
        found = now(service)
        if found["state"] != "working":
            return found
        time.sleep(0.01)
    raise AssertionError(found)


def answer(client, question, value=None):
    return client.post("/commission/answer", json={"question": question, "value": value})


def begun(service, client=None):
    made = (client or service.client).post("/commission", json={"travel_deg": 100})
    assert made.status_code == 201, made.text
    return asked(service)["question"]


def test_a_bench_that_is_simulated_here_says_how_to_commission_a_drive(idle):
    assert "serve --drive drive.toml" in now(idle)["obstacle"]
    refused = idle.client.post("/commission")
    assert refused.status_code == 409
    assert "drives on a wire" in refused.json()["detail"]
    assert now(idle)["state"] == "none"


def test_all_answers_lead_to_both_files(joint):
    begun(joint)
    for value in ANSWERS:
        found = asked(joint)
        question = found["question"]
        assert question["wants_value"] is (question["key"] not in ("down", "clear"))
        assert answer(joint.client, question["number"], value).status_code == 200
    ended = asked(joint)
    assert ended["state"] == "commissioned"
    assert ended["first_load"] == {"hung_kg": 0.05, "found_kg": pytest.approx(0.0503)}
    file = joint.client.get("/commission/bench.toml")
    assert 'filename="bench.toml"' in file.headers["content-disposition"]
    parse_configuration(tomllib.loads(file.text), "bench.toml")
    evidence = [Finding(**one) for one in joint.client.get("/commission/evidence.json").json()]
    assert [one.name for one in evidence] == [one["name"] for one in ended["evidence"]]
    assert (evidence[-1].low, evidence[-1].high) == (0.58, 0.64)
    told = {"answered 'motor_current_a' of the commissioning: 3", "began commissioning 1"}
    wait_for(
        lambda: told <= {one["detail"] for one in joint.client.get("/audit").json()["items"]}
    )  # a thread writes it


def test_what_will_move_stands_beside_the_question(joint):
    begun(joint)
    steps = {one["key"]: one for one in now(joint)["steps"]}
    assert steps["know"]["low_rad"] == steps["know"]["high_rad"] == 0.0
    assert "Nothing is powered" in steps["know"]["moves"]
    assert steps["push"]["high_rad"] == pytest.approx(0.9)  # 1.5 times there and on, see `identification`
    assert now(joint)["step"] == "know"


def test_an_answer_out_of_bounds_or_too_late_changes_nothing(joint):
    first = begun(joint)
    refused = answer(joint.client, first["number"], 7.0)
    assert refused.status_code == 422
    assert "arm_length_m is 7 m; allowed is 0.02 .. 3 m" in refused.json()["detail"]
    assert answer(joint.client, first["number"]).status_code == 422  # it has to be known
    assert asked(joint)["question"] == first
    assert answer(joint.client, first["number"], 0.3).status_code == 200
    assert asked(joint)["question"]["key"] == "gear_ratio"
    late = answer(joint.client, first["number"], 0.3)
    assert late.status_code == 409
    assert asked(joint)["question"]["key"] == "gear_ratio"


def test_nothing_else_starts_meanwhile_and_nobody_else_answers(joint):
    question = begun(joint)
    again = joint.client.post("/commission")
    assert (again.status_code, again.json()["kind"]) == (409, "BusyError")
    started = joint.client.post("/experiments", json={"kind": "steps"})
    assert started.status_code == 409
    assert "commissioning 1 is under way" in started.json()["detail"]
    with joint.with_token("other", "operator") as other:
        held = answer(other, question["number"], 0.3)
        assert (held.status_code, held.json()["kind"]) == (409, "LeaseHeldError")
    assert asked(joint)["question"] == question
    assert joint.store.experiments() == []


def test_a_viewer_may_not_begin_and_may_stop(joint):
    with joint.with_token("watcher", "viewer") as viewer:
        assert viewer.post("/commission").status_code == 403
        begun(joint)
        assert viewer.post("/stop", json={"reason": "the arm is caught"}).status_code == 200
    ended = asked(joint)
    assert (ended["state"], ended["refusal"]) == ("refused", "the arm is caught")
    assert joint.client.get("/commission/bench.toml").status_code == 404
    assert joint.client.get("/commission/evidence.json").json()[0]["name"] == "drive"
    assert joint.client.get("/lease").json()["lease"] is None
    assert begun(joint)["key"] == "arm_length_m"


def test_a_joint_that_is_not_known_is_moved_by_commissioning_alone(joint):
    for kind in ("steps", "identification", "commissioning"):
        refused = joint.client.post("/experiments", json={"kind": kind})
        assert refused.status_code == 409
        assert "is not known yet: commission it" in refused.json()["detail"]
    assert joint.store.experiments() == []
