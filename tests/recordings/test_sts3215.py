"""A Feetech STS3215 pendulum under four masses: what one mass cannot tell apart, several can."""

import pytest

LOAD_FRICTION = {"load_friction", "load_friction_quadratic"}
PART = ("--where", "kp=8", "--where", "arm_m=0.1", "--where", "repeat=1")  # of 320 trials: one gain, length and repeat


@pytest.mark.timeout(300)
def test_friction_that_grows_with_the_load_is_named_and_holds_for_a_mass_that_was_not_fitted(command):
    experiment = command.import_set("sts3215")
    made = command("study", "new", "sts", "--experiment", experiment, *PART, "--hold-out", "load_kg=1.1682")
    study_id = made["study_id"]
    diagnosis = command("study", "diagnose", study_id)
    assert diagnosis["verdict"] == "missing"
    assert diagnosis["ranking"][0]["effect"] in LOAD_FRICTION
    change = command("study", "add", study_id, diagnosis["ranking"][0]["effect"])
    assert change["after"]["held_out"] <= 0.85 * change["before"]["held_out"]
    assert command("study", "compare", study_id)["error"]["held_out"]["kind"] == "hold-out"
