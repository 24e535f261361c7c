"""A Dynamixel XL330 pendulum (Rhoban/bam): friction that grows with the load, from duty x supply alone."""

import pytest

LOAD_FRICTION = {"load_friction", "load_friction_quadratic"}


@pytest.mark.timeout(300)
def test_load_dependent_friction_is_named_and_halves_the_error_and_the_search_stops_where_no_trial_gains(command):
    made = command("study", "new", "xl330", "--experiment", command.import_set("xl330"))
    study_id, named, changes = made["study_id"], [], []
    assert made["effort"]["unit"] == "V"
    for _ in range(6):
        diagnosis = command("study", "diagnose", study_id)
        if diagnosis["verdict"] != "missing":
            break
        named.append(set(diagnosis["classes"][0]["effects"]))
        changes.append(command("study", "add", study_id, diagnosis["ranking"][0]["effect"]))
    assert LOAD_FRICTION & named[0]
    assert changes[0]["after"]["held_out"] <= 0.55 * changes[0]["before"]["held_out"]
    assert command("study", "compare", study_id)["error"]["held_out"]["kind"] == "leave-one-trial-out"
    errors = [rung["held_out"] for rung in command("study", "ladder", study_id)["rungs"]]
    assert diagnosis["verdict"] == "nothing"
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] <= 0.5 * errors[0]


def test_the_motion_comes_nearer_with_the_effect_that_is_named(command):
    """Each trial with the coefficients of the others, under the servo that its own set point and effort tell."""
    study_id = command("study", "new", "xl330", "--experiment", command.import_set("xl330"))["study_id"]
    before = command("study", "simulate", study_id)
    assert sum(one["law"] == "recording" for one in before["trials"]) >= 15
    command("study", "add", study_id, "load_friction_quadratic")
    after = command("study", "simulate", study_id, "--refine")
    assert after["held_out"]["position"] < 0.6 * before["held_out"]["position"]
    assert after["held_out"]["effort_relative"] < 0.6 * before["held_out"]["effort_relative"]
    assert after["refined"]["held_out"]["effort"] < after["held_out"]["effort"]
