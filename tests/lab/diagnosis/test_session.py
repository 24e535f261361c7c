"""What changes within a session and is no warm-up varies with the time in it, and is not given the name of one."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import SESSION_START, Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.rows.drivers import available
from tests.lab.diagnosis.test_motor_warm_up import BETWEEN_S, fitted, session
from tests.lab.synthetic import FACTS, recordings

CURVE = "curve_of_session_time_against_motion"
JUMP_S = 10.5 * BETWEEN_S


def tightened(one: Recording) -> Recording:
    """From one moment of the session on, somebody has tightened a bearing."""
    speed = np.gradient(one.channels["position_rad"], one.channels["time_s"])
    excess = 0.04 * float(float(one.conditions[SESSION_START]) > JUMP_S)
    return replace(one, channels={**one.channels, "torque_n_m": one.channels["torque_n_m"] + excess * np.sign(speed)})


@pytest.fixture(scope="module")
def jumped() -> list[Recording]:
    return [tightened(one) for one in recordings(trials=session(), seed=3)]


def test_friction_that_jumps_in_a_session_varies_with_the_time_in_it(jumped):
    found = diagnose(fitted(jumped))
    assert (found.verdict, found.driver) == ("unknown-effect", "session_time against motion"), found.sentence


def test_the_curve_over_the_session_takes_much_of_a_jump_away(jumped):
    before, after = (held_out(fitted(jumped, *added)).relative for added in ((), (CURVE,)))
    assert after < 0.6 * before


def test_where_no_trial_tells_when_it_began_there_is_no_time_in_the_session(jumped):
    untold = [replace(one, conditions={**one.conditions, SESSION_START: 0.0}) for one in jumped]
    assert "session_time" not in available(make_dataset(untold, FACTS, Processing()))
    with pytest.raises(NotApplicableError, match="needs session_s to differ"):
        fitted(untold, CURVE)
    assert "session_time" in available(make_dataset(jumped, FACTS, Processing()))
