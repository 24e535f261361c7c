"""`friction-bench queue` and `campaign`, against a service and without one."""

import json
from collections.abc import Callable

import pytest

from bench.study.suggestion.suggested import Suggested, SuggestedTrial
from tests.queue.waiting import wait_for
from tests.service.running_service import TOKEN, running_service

CAMPAIGN = 'kind = "coast-down"\npace = "fast"\n[parameters]\nspeeds_rad_s = [1.0]\n[grid]\nload_kg = [0.05, 0.0]\n'


@pytest.fixture
def asked(command, monkeypatch, tmp_path) -> Callable[..., dict]:
    """A command to a service that runs; its answer."""
    (tmp_path / "served").mkdir()
    with running_service(tmp_path / "served") as service:
        monkeypatch.setenv("FRICTION_BENCH_URL", service.url)
        monkeypatch.setenv("FRICTION_BENCH_TOKEN", TOKEN)

        def run(*words: str) -> dict:
            done = command(*words)
            assert done.exit_code == 0, done.output
            return json.loads(done.stdout) if "--json" in words else {"said": done.stdout}

        yield run


def test_from_add_to_the_end(asked, tmp_path):
    assert asked("queue", "pause", "--json")["state"] == "held"
    added = [asked("queue", "add", "steps", "repeats=1", "load-kg=0.05", "--tags", "a,b", "--json") for _ in range(3)]
    first, second, third = (one["item_ids"][0] for one in added)
    asked("queue", "move", third, 1)
    asked("queue", "remove", second)
    found = asked("queue", "list", "--json")
    assert [item["item_id"] for item in found["waiting"]] == [third, first]
    assert found["waiting"][0]["parameters"] == {"repeats": "1", "load_kg": "0.05"}
    assert "steps" in asked("queue", "list")["said"]
    assert "2 removed" in asked("queue", "clear")["said"]
    (tmp_path / "loads.toml").write_text(CAMPAIGN, encoding="utf-8")
    assert len(asked("campaign", "start", tmp_path / "loads.toml", "--json")["item_ids"]) == 2
    asked("queue", "resume")
    wait_for(lambda: asked("queue", "list", "--json")["state"] == "idle")
    ended = asked("queue", "list", "--json")["ended"]
    assert [(item["kind"], item["state"]) for item in ended] == [("coast-down", "completed")] * 2


def test_a_plan_needs_no_service(command, tmp_path):
    file = tmp_path / "loads.toml"
    file.write_text(CAMPAIGN, encoding="utf-8")
    shown = command("campaign", "plan", file)
    assert shown.exit_code == 0, shown.output
    assert "2 experiments, about" in shown.output
    plan = json.loads(command("campaign", "plan", file, "--json").stdout)
    assert (plan["name"], plan["load_changes"]) == ("loads", 2)
    file.write_text(CAMPAIGN.replace("0.05", "5.0"), encoding="utf-8")
    refused = command("campaign", "plan", file)
    assert refused.exit_code == 3
    assert "load_kg is 5 kg" in refused.output


def test_a_wrong_parameter_is_named(command):
    wrong = command("queue", "add", "steps", "repeat=3")
    assert wrong.exit_code == 2
    assert "NAME=VALUE" in wrong.output


def test_tags_of_a_run_are_found_again(command):
    ran = command("run", "steps", "--repeats", 1, "--tags", "winter, new grease", "--json")
    assert ran.exit_code == 0, ran.output
    assert json.loads(ran.stdout)["tags"] == ["new grease", "winter"]
    assert [one["tags"] for one in json.loads(command("experiments", "--tag", "winter", "--json").stdout)] == [
        ["new grease", "winter"]
    ]
    assert json.loads(command("experiments", "--tag", "summer", "--json").stdout) == []


def test_what_a_study_suggests_goes_into_the_queue_with_the_study_s_note(asked, command, monkeypatch):
    trials = [
        SuggestedTrial(
            name="",
            kind="steps",
            parameters={"repeats": 1, "load_kg": load_kg},
            minutes=1.0,
            before=0.0,
            after=6.0,
            sentence="",
        )
        for load_kg in (0.0, 0.05)
    ]
    found = Suggested.model_construct(study_id=4, note="suggested for study 4", trials=trials)
    monkeypatch.setattr("bench.cli.lab.study_trials.suggested", lambda *_: found)
    assert asked("queue", "pause", "--json")["state"] == "held"
    assert asked("study", "suggest", "4", "--queue", "--json")["item_ids"] == [1, 2]
    waiting = asked("queue", "list", "--json")["waiting"]
    assert [(one["kind"], one["parameters"]["load_kg"], one["note"]) for one in waiting] == [
        ("steps", 0.0, "suggested for study 4"),
        ("steps", 0.05, "suggested for study 4"),
    ]
    both = command("study", "suggest", "4", "--queue", "--start")
    assert both.exit_code == 2
    assert "--queue on the service" in both.stderr


def test_the_laboratorys_queue_needs_no_service(command, tmp_path):
    added = command("lab-queue", "add", "steps", "repeats=2", "--needs", "torque sensor", "--rig", "paper", "--json")
    assert added.exit_code == 0, added.output
    [first] = json.loads(added.stdout)["item_ids"]
    (tmp_path / "loads.toml").write_text(CAMPAIGN, encoding="utf-8")
    assert command("lab-queue", "campaign", tmp_path / "loads.toml", "--bench", "gear 3").exit_code == 0
    found = json.loads(command("lab-queue", "list", "--json").stdout)["open"]
    assert [(one["kind"], one["for_bench"], one["for_rig"], one["for_tags"], one["state"]) for one in found] == [
        ("steps", "", "paper", ["torque sensor"], "waiting"),
        ("coast-down", "gear 3", "", [], "waiting"),
        ("coast-down", "gear 3", "", [], "waiting"),
    ]
    assert "3 waiting; see friction-bench lab-queue list" in command("benches").stdout
    assert "torque sensor" in command("lab-queue", "list").stdout
    assert command("lab-queue", "remove", first).exit_code == 0
    assert command("lab-queue", "remove", first).exit_code != 0
    assert command("lab-queue", "add", "magic").exit_code != 0
