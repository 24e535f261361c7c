"""The margins are those of the loop that is simulated, and the gains leave them."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.errors import CalibrationError
from compensator.motion.servo_design import LEAST_GAIN, LEAST_PHASE_DEG, Gains, Loop, design, margins
from sim_backend.challenge.joint import draw_joint
from tests.commission import servos

LOOP = Loop((0.022, 0.047), 0.009, 0.002, 0.0075)


def _swing(gains: Gains, inertia: float, loop: Loop, factor: float = 1.0) -> float:
    """Largest error in the second half of two seconds, as a share of that in the first: above 1 it grows."""
    step_s = 5e-5
    lag = round(loop.delay_s / step_s)
    past = [(0.0, 0.0)] * lag
    position, speed, integral, errors = 1.0, 0.0, 0.0, []
    for _ in range(round(2.0 / step_s)):
        past.append((position, speed))
        seen, seen_speed = past[-1 - lag]
        integral -= gains.integral_a_rad_s * seen * step_s
        current = factor * (integral - gains.proportional_a_rad * seen - gains.derivative_a_s_rad * seen_speed)
        speed += (current - loop.viscous_a_s_rad * speed) / inertia * step_s
        position += speed * step_s
        errors.append(abs(position))
        if abs(position) > 1e3:
            break
    half = len(errors) // 2
    return max(errors[half:]) / max(errors[:half])


@pytest.mark.parametrize("inertia", LOOP.inertias_a_s2_rad)
def test_the_gain_margin_is_where_the_loop_begins_to_swing(inertia):
    gains = design(LOOP).gains
    margin = margins(gains, inertia, LOOP).gain
    assert _swing(gains, inertia, LOOP, 0.93 * margin) < 1.0
    assert _swing(gains, inertia, LOOP, 1.07 * margin) > 1.0


def test_every_load_has_its_margins():
    found = design(LOOP)
    assert all(one.phase_deg >= LEAST_PHASE_DEG and one.gain >= LEAST_GAIN for one in found.margins)
    assert found.free_gain > 1.0


@pytest.mark.parametrize("growth", [1.2, 2.0, 5.0])
def test_the_loads_in_between_have_them_too(growth):
    lightest = LOOP.inertias_a_s2_rad[0]
    loop = replace(LOOP, inertias_a_s2_rad=(lightest, growth * lightest))
    gains = design(loop).gains
    for inertia in np.linspace(lightest, growth * lightest, 21):
        found = margins(gains, float(inertia), loop)
        assert found.phase_deg >= LEAST_PHASE_DEG
        assert found.gain >= LEAST_GAIN


@pytest.mark.parametrize("number", [3, 6])  # of 20 drawn rigs, where the load weighs most beside the joint
def test_one_servo_moves_the_joint_without_half_and_with_the_heaviest_load(number):
    joint = draw_joint(np.random.default_rng([1, number]))
    period_s = (0.005, 0.01)[number % 2]
    proposal = servos.proposed(joint, period_s, number)
    found = servos.qualities(joint, period_s, number, proposal, proposal.servo)
    assert [one.is_sound for one in found] == [True] * 3
    # `python -m tests.commission.servos 20` lays each beside the best for its load
    assert max(one.settled_s for one in found) <= servos.ALLOWED_RATIO * min(one.settled_s for one in found)


def test_a_servo_that_overshoots_or_swings_is_not_sound():
    joint = draw_joint(np.random.default_rng([1, 0]))
    proposal = servos.proposed(joint, 0.005, 0)
    loose = proposal.servo.model_copy(update={"derivative_a_s_rad": 0.0})
    assert not all(one.is_sound for one in servos.qualities(joint, 0.005, 0, proposal, loose))


def test_a_loop_that_swings_has_no_margin():
    wild = Gains(200.0, 2000.0, 5.0)
    assert margins(wild, 0.022, LOOP).phase_deg < 0.0
    assert _swing(wild, 0.022, LOOP) > 1.0


def test_a_longer_delay_asks_for_a_slower_servo():
    bandwidths = [design(replace(LOOP, delay_s=delay_s)).bandwidth_rad_s for delay_s in (0.01, 0.02, 0.04)]
    assert bandwidths == sorted(bandwidths, reverse=True)
    assert np.all(np.diff(bandwidths) < 0.0)


def test_a_loop_that_no_servo_holds_is_refused():
    with pytest.raises(CalibrationError, match="shorten the control period"):
        design(replace(LOOP, delay_s=0.5))
