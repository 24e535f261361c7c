"""`friction-bench doctor` on the simulated bench; on real drives see tests/drivers."""

import json
from dataclasses import replace

from bench.runs import connection, scope


def test_it_says_what_the_drive_is_and_moves_nothing(command):
    found = command("doctor", "--json")
    assert found.exit_code == 0, found.output
    connection = json.loads(found.stdout)["connection"]
    assert connection["description"]["modes"] == ["duty"]
    assert connection["sample"]["status"] == "DISABLED"
    assert connection["sample"]["current_a"] is None
    assert command("experiments", "--json").stdout.strip() == "[]"


def test_the_move_is_an_experiment_on_record(command):
    found = command("doctor", "--move", "--operator", "R. Saini")
    assert found.exit_code == 0, found.output
    assert "commissioning move: completed" in found.output
    [experiment] = json.loads(command("experiments", "--json").stdout)
    assert (experiment["kind"], experiment["outcome"], experiment["operator"]) == (
        "commissioning",
        "completed",
        "R. Saini",
    )


def test_it_ends_with_the_setting_that_is_to_be_added(command, monkeypatch):
    assert "To be added" not in command("doctor").output
    monkeypatch.setattr(scope, "setting_to_add", lambda *_: "set rated_current_a in [drive]")
    said = command("doctor").output.splitlines()
    assert said[-1] == "To be added to the bench's file: set rated_current_a in [drive]."


def test_a_drive_without_any_mode_is_not_passed_over(command, monkeypatch):
    connect = connection.connect

    def without_modes(configuration):
        found = connect(configuration)
        return replace(found, description=replace(found.description, modes=frozenset()))

    monkeypatch.setattr(connection, "connect", without_modes)
    found = command("doctor")
    assert found.exit_code == 3
    assert "has no mode that can be used" in found.output.replace("\n", " ")
    assert json.loads(command("doctor", "--json").stdout)["connection"]["description"]["modes"] == []


def test_a_zero_needs_a_drive_on_a_wire(command):
    found = command("doctor", "--set-zero")
    assert found.exit_code == 3
    assert "needs a drive on a wire" in found.output


def test_it_says_what_can_be_compensated_and_what_cannot(command):
    found = command("doctor")
    assert "What can be compensated here, and what cannot" in found.output
    rows = json.loads(command("doctor", "--json").stdout)["scope"]
    assert {one["answer"] for one in rows} <= {"yes", "in part", "no"}
    assert all(one["what"] and one["why"] for one in rows)
