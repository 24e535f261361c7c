"""Ways of compensation on motions made by hand, where the load is known."""

from math import inf, nan

import numpy as np
import pytest

from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motion.load_estimate import EstimatorSettings, Observation, RestResult
from compensator.rivals import RIVALS, Knowledge
from compensator.rivals.rival import smoothed

RATIO, PERIOD_S, COUNT_RAD = 20.0, 0.005, 7.7e-5
LIGHT = KineticFriction(0.06, 0.1, 5.0, 2.0, 2e-3)
HEAVY = KineticFriction(0.16, 0.26, 5.0, 2.0, 2e-3)
KNOWLEDGE = Knowledge(
    lookup=FrictionLookup.over_friction({0.1: LIGHT, 0.26: HEAVY}),
    fixed=LIGHT,
    ratio=RATIO,
    inertia_a_s2_rad=0.03,
    breakaway_rad=4.0 * COUNT_RAD,
    settings=EstimatorSettings(PERIOD_S, COUNT_RAD, 0.01, 0.004),
    model=None,  # only `online` looks at it
)
BY_NAME = {rival.name: rival for rival in RIVALS}
LOAD_A = 0.2


def run(name, positions, currents, targets=None, rest=None):
    """Estimates of a rival over a motion."""
    rival = BY_NAME[name]
    state, given = rival.begin(KNOWLEDGE), []
    for row, (position, current) in enumerate(zip(positions, currents, strict=True)):
        target = position if targets is None else targets[row]
        seen = Observation(position, current, target, rest=rest if row == 0 else None)
        state, estimate = rival.advance(KNOWLEDGE, state, seen)
        given.append(estimate.load_current_a)
    return np.array(given)


def cruise(speed, curve, seconds=2.0):
    """A steady speed of the joint with the load of 0.2 A on it."""
    time_s = np.arange(0.0, seconds, PERIOD_S)
    return speed * time_s, np.full(len(time_s), LOAD_A + float(curve.sliding_a(speed * RATIO)))


@pytest.mark.parametrize("speed", [2.0, -3.0])
@pytest.mark.parametrize("name", ["fixed", "dahl", "reset-integrator", "lugre-observer", "disturbance-observer"])
def test_those_with_the_right_curve_find_the_load_at_a_steady_speed(name, speed):
    # at 40 rad/s of the motor the Stribeck rise has gone: that Dahl and the reset integrator know none does not show
    given = run(name, *cruise(speed, LIGHT))
    assert given[-1] == pytest.approx(LOAD_A, abs=1e-3)


def test_the_paper_selects_the_curve_by_f_load_where_one_curve_is_wrong():
    motion = cruise(2.0, HEAVY)
    wrong_a = float(HEAVY.sliding_a(40.0) - LIGHT.sliding_a(40.0))
    assert run("fixed", *motion)[-1] == pytest.approx(LOAD_A + wrong_a, abs=1e-3)
    told = run("paper", *motion, rest=RestResult(0.0, inf, 0.26))
    assert told[-1] == pytest.approx(LOAD_A, abs=1e-6)
    assert run("uncompensated", *motion)[-1] == pytest.approx(motion[1][-1])


def test_at_rest_only_a_search_tells():
    positions, currents = np.zeros(100), np.full(100, 0.29)  # anything in 0.2 -+ 0.1 holds the joint
    for name in ("uncompensated", "fixed", "dahl", "reset-integrator", "disturbance-observer"):
        assert run(name, positions, currents)[-1] == pytest.approx(0.29, abs=1e-3), name
    assert run("paper", positions, currents, rest=RestResult(LOAD_A, 0.01, 0.1))[-1] == LOAD_A
    assert np.isnan(run("paper", positions, currents)[-1])


def test_bristles_springs_and_bonds_remember_which_way_the_joint_came():
    positions = np.concatenate([np.linspace(0.0, 0.1, 200), np.full(100, 0.1)])
    friction_a = float(LIGHT.sliding_a(0.05 * RATIO))
    currents = np.full(len(positions), LOAD_A + friction_a)
    for name, kept_a in (("dahl", LIGHT.coulomb_a), ("reset-integrator", LIGHT.coulomb_a)):
        assert run(name, positions, currents)[-1] == pytest.approx(LOAD_A + friction_a - kept_a, abs=1e-3), name
    # over eq. (2) at creep the bristles are bent as far as that allows; the observer follows
    assert run("lugre-observer", positions, currents)[-1] == pytest.approx(LOAD_A, abs=0.02)


def test_stuck_at_a_wall_the_paper_takes_friction_as_in_motion_towards_the_set_point():
    positions, currents = np.full(200, 0.4), np.full(200, 1.0)
    targets = np.full(200, 0.6)
    given = run("paper", positions, currents, targets, rest=RestResult(0.0, inf, 0.26))
    assert given[-1] == pytest.approx(1.0 - 0.26, abs=1e-3)
    below = run("paper", positions, -currents, -targets + 0.8, rest=RestResult(0.0, inf, 0.26))
    assert below[-1] == pytest.approx(-1.0 + 0.26, abs=1e-3)


def test_observers_take_inertia_off_and_the_others_take_it_for_load():
    time_s = np.arange(0.0, 4.0, PERIOD_S)
    positions = 0.5 * np.sin(3.0 * time_s)
    speed, acceleration = 1.5 * np.cos(3.0 * time_s), -4.5 * np.sin(3.0 * time_s)
    currents = LOAD_A + LIGHT.sliding_a(speed * RATIO) + KNOWLEDGE.inertia_a_s2_rad * acceleration
    late = slice(400, None)
    observed = np.sqrt(np.mean((run("disturbance-observer", positions, currents)[late] - LOAD_A) ** 2))
    plain = np.sqrt(np.mean((run("fixed", positions, currents)[late] - LOAD_A) ** 2))
    assert plain > 0.08  # 0.135 A of amplitude
    assert observed < 0.4 * plain


def test_smoothing_has_the_observers_time_constant_and_begins_anew_after_a_gap():
    step = np.concatenate([np.zeros(10), np.ones(200), [nan], np.full(3, 5.0)])
    given = smoothed(step, PERIOD_S)
    # 1 - exp(-t w), w = 2 pi 5 Hz, after seven samples
    assert given[16] == pytest.approx(1.0 - np.exp(-7 * PERIOD_S * 2.0 * np.pi * 5.0))
    assert np.isnan(given[210])
    assert given[211] == 5.0


def test_names_are_unique_and_two_search():
    assert len(BY_NAME) == len(RIVALS) == 8
    assert [rival.name for rival in RIVALS if rival.searches] == ["paper", "online"]
