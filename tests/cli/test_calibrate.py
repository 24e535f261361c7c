"""`friction-bench calibrate`."""

import json
from dataclasses import replace

import pytest

from bench.cli.operation import calibration_run
from bench.cli.operation.run import carry_out

pytestmark = pytest.mark.timeout(300)  # seconds by itself; a shared machine may take minutes
LEVELS = ("--loads-kg", "0,0.1", "--duties", "0.2", "--minutes", "0.5")


def test_run_keeps_shows_lists_and_uses(command):
    made = command("calibrate", "run", *LEVELS, "--note", "at the start", "--json")
    assert made.exit_code == 0, made.output
    found = json.loads(made.stdout)
    assert [curve["load_kg"] for curve in found["curves"]] == [0.0, 0.1]
    assert found["experiment_ids"] == [1, 2, 3]  # the search, and one batch under each load
    again = command("calibrate", "fit", *(word for one in (1, 2, 3) for word in ("--experiment", one)))
    assert "calibration 2 of rig 'paper', from experiments 1, 2, 3" in again.stdout
    told = command("calibrate", "show", 1).stdout.replace("\n", " ")
    assert "ohmmeter" in told
    assert "on one side alone" not in told
    assert "calibration 2" in command("calibrate", "use", "--latest").stdout
    assert "calibration 1" in command("calibrate", "use", 1).stdout
    listed = json.loads(command("calibrate", "list", "--json").stdout)
    assert [(one["calibration_id"], one["in_use"]) for one in listed] == [(2, False), (1, True)]


def test_what_is_wrong_is_said_and_nothing_is_kept(command):
    assert command("calibrate", "use").exit_code == 2
    missing = command("calibrate", "fit", "--experiment", "7")
    assert missing.exit_code == 3
    assert "experiment 7 is not in the store" in missing.stderr
    assert command("calibrate", "run", "--loads-kg", "heavy").exit_code == 2
    refused = command("calibrate", "run", "--loads-kg", "0,5")
    assert refused.exit_code == 3
    assert json.loads(command("calibrate", "list", "--json").stdout) == []


def test_it_says_before_what_it_takes_and_goes_on_where_it_was_broken_off(command):
    made = command("calibrate", "run", *LEVELS)
    assert made.exit_code == 0, made.output
    said = " ".join(made.output.split())
    assert "2 loads are searched at rest" in said
    assert "minutes of the joint's time" in said
    assert "hanging and on both sides" in said
    assert said.index("minutes of the joint's time") < said.index("load-sweep: 6 trials")
    # the records of the search and of the first load are there: only the second load is measured
    again = command("calibrate", "run", *LEVELS, "--after", 1, "--after", 2, "--json")
    assert json.loads(again.stdout)["experiment_ids"] == [1, 2, 4]


def test_a_duty_above_the_limit_is_refused_before_the_first_stroke(command):
    refused = command("calibrate", "run", "--loads-kg", "0,0.1", "--minutes", "0.5", "--duties", "0.9")
    assert refused.exit_code == 3
    assert json.loads(command("calibrate", "list", "--json").stdout) == []


def test_a_calibration_that_is_broken_off_says_the_whole_command_that_goes_on(command, monkeypatch):
    done = []

    def stopped_at_the_second(*given, **named):
        found, _ = carry_out(*given, **named)
        done.append(found.id)
        return (found, None) if len(done) == 1 else (replace(found, outcome="stopped", reason="somebody asked"), None)

    monkeypatch.setattr(calibration_run, "carry_out", stopped_at_the_second)
    told = command("calibrate", "run", *LEVELS, "--pace", "fast")
    assert told.exit_code == 1
    options = "--loads-kg 0,0.1 --minutes 0.5 --duties 0.2 --pace fast"
    assert f"friction-bench calibrate run {options} --after {done[0]}" in " ".join(told.output.split())


def test_loads_on_one_side_alone_are_said_with_the_result(command):
    angles = ("--loads-kg", "0,0.05,0.1", "--angles-rad", "0,1.2")
    assert command("run", "load-sweep", *angles).exit_code == 0
    assert command("run", "speed-sweep", "--loads-kg", "0,0.1", "--duties", "0.2", "--strokes", "4").exit_code == 0
    made = command("calibrate", "fit", "--experiment", 1, "--experiment", 2)
    assert "on one side alone" in " ".join(made.output.split())
