from math import atan2, cos, exp, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import ARM, G, duty_for_torque, plant, run

LEVER, MASS, DAMPING, STIFFNESS = 0.3, 0.5, 4.0, 120.0
HAND = {
    "present": True, "lever_m": LEVER, "mass_kg": MASS, "damping_n_s_m": DAMPING, "stiffness_n_m": STIFFNESS,
}  # fmt: skip
FREE = {"backlash_rad": 6.0}  # the arm alone: the rotor is out of reach
INERTIA = ARM + LEVER**2 * MASS


def _arm_in_hand(**operator: Any) -> Plant:
    return plant(gear=FREE, operator=HAND | operator)


def test_without_an_operator_there_is_no_hand() -> None:
    alone = plant(operator=HAND | {"present": False, "hold_rad": 1.0})
    alone.advance(OPEN, 0.0, 1000)
    assert (alone.truth().arm_rad, alone.truth().hand_n_m, alone.energy().supplied_j) == (0.0, 0.0, 0.0)


def test_arm_swings_into_the_hand_s_position_as_its_impedance_says() -> None:
    hold = 0.2
    held = _arm_in_hand(hold_rad=hold)
    decay = 0.5 * LEVER**2 * DAMPING / INERTIA
    natural = sqrt(LEVER**2 * STIFFNESS / INERTIA)
    damped = sqrt(natural**2 - decay**2)
    for _ in range(20):
        held.advance(OPEN, 0.0, 200)
        t = held.time_s
        left = exp(-decay * t) * (cos(damped * t) + decay / damped * sin(damped * t))
        # the midpoint rule is late by (w h)^2 / 12 of the phase: 1e-7 here
        assert held.truth().arm_rad == pytest.approx(hold * (1.0 - left), abs=1e-6)


@pytest.mark.parametrize("frequency_hz", [0.5, 2.0, 6.0])
def test_arm_follows_a_sinusoid_with_gain_and_lag_of_the_impedance(frequency_hz: float) -> None:
    waved = _arm_in_hand(amplitude_rad=0.3, frequency_hz=frequency_hz)
    turn = 2.0 * pi * frequency_hz
    pull = LEVER**2 * complex(STIFFNESS, turn * DAMPING)
    gain = pull / (pull - INERTIA * turn**2)
    waved.advance(OPEN, 0.0, 30_000)
    for _ in range(20):
        waved.advance(OPEN, 0.0, 73)
        wanted = 0.3 * abs(gain) * sin(turn * waved.time_s + atan2(gain.imag, gain.real))
        assert waved.truth().arm_rad == pytest.approx(wanted, abs=1e-5 * abs(gain))


def test_reach_of_least_jerk_peaks_at_15_eighths_of_its_mean_speed() -> None:
    stiff = {"stiffness_n_m": 2e5, "damping_n_s_m": 600.0}
    reached = _arm_in_hand(**stiff, reach_rad=0.8, reach_start_s=0.5, reach_duration_s=2.0)
    reached.advance(OPEN, 0.0, 5000)
    assert reached.truth().arm_rad == 0.0
    reached.advance(OPEN, 0.0, 10_000)
    # inertia lags behind a stiff hand by (acceleration / stiffness), which is 0 half-way; its jerk is not
    assert reached.truth().arm_rad == pytest.approx(0.4, rel=1e-4)
    assert reached.truth().arm_rad_s == pytest.approx(1.875 * 0.8 / 2.0, rel=1e-3)
    reached.advance(OPEN, 0.0, 20_000)
    assert reached.truth().arm_rad == pytest.approx(0.8, rel=1e-6)


def test_hand_carries_the_load_that_gravity_hangs_on_it() -> None:
    loaded = plant(gear=FREE, load={"mass_kg": 0.2}, operator=HAND | {"hold_rad": 1.0})
    loaded.advance(OPEN, 0.0, 150_000)
    truth = loaded.truth()
    assert truth.hand_n_m == pytest.approx(0.2 * 0.3 * G * sin(truth.arm_rad), rel=1e-9)
    assert truth.hand_n_m == pytest.approx(LEVER**2 * STIFFNESS * (1.0 - truth.arm_rad), rel=1e-9)


def test_interaction_torque_is_what_moves_the_arm() -> None:
    """Newton's law of the arm without the hand's own inertia, step by step."""
    moved = _arm_in_hand(amplitude_rad=0.3, frequency_hz=3.0)
    before = moved.truth().arm_rad_s
    for _ in range(500):
        moved.advance(OPEN, 0.0, 1)
        after = moved.truth().arm_rad_s
        assert moved.truth().hand_n_m * 1e-4 == pytest.approx(ARM * (after - before), rel=1e-9, abs=1e-14)
        before = after


def test_hand_pulls_with_no_more_than_its_strength() -> None:
    weak = plant(
        friction={"viscous_n_m_s_rad": 1e-3},
        operator=HAND | {"strength_n": 2.0, "mass_kg": 0.0},
    )
    run(weak, duty_for_torque(1.0), 1.0)
    assert weak.truth().hand_n_m == pytest.approx(-2.0 * LEVER, rel=1e-12)
    assert weak.truth().arm_rad > 1.0  # the motor has torn itself away
    strong = plant(friction={"viscous_n_m_s_rad": 1e-3}, operator=HAND | {"strength_n": 20.0})
    run(strong, duty_for_torque(1.0), 5.0)
    assert strong.truth().arm_rad == pytest.approx(1.0 / (LEVER**2 * STIFFNESS), rel=1e-6)


def test_hand_takes_hold_at_the_arm_s_speed_and_lets_go() -> None:
    caught = _arm_in_hand(grip_s=0.1, release_s=0.3, hold_rad=0.0)
    caught.place(0.0, 0.0, arm_rad_s=2.0)
    caught.advance(OPEN, 0.0, 1000)
    assert (caught.truth().arm_rad_s, caught.truth().hand_n_m) == (2.0, 0.0)
    caught.advance(OPEN, 0.0, 1)
    # spring and damper of the hand, not a blow of its mass
    pull = LEVER**2 * (STIFFNESS * 0.2 + DAMPING * 2.0)
    assert caught.truth().arm_rad_s == pytest.approx(2.0 - pull / INERTIA * 1e-4, rel=1e-5)
    caught.advance(OPEN, 0.0, 2000)
    leaving = caught.truth().arm_rad_s
    caught.advance(OPEN, 0.0, 1000)
    assert (caught.truth().arm_rad_s, caught.truth().hand_n_m) == (leaving, 0.0)


@settings(max_examples=50)
@given(
    mass=st.floats(0.0, 3.0),
    damping=st.floats(0.0, 40.0),
    stiffness=st.one_of(st.just(0.0), st.floats(1e-3, 1000.0)),
    strength=st.floats(0.5, 100.0),
    start=st.floats(-1.0, 1.0),
    speed=st.floats(-3.0, 3.0),
    gap=st.sampled_from([0.0, 0.02, 6.0]),
    spin=st.floats(-3.0, 3.0),
)
def test_hand_that_holds_still_is_passive(
    mass: float, damping: float, stiffness: float, strength: float, start: float, speed: float, gap: float, spin: float
) -> None:
    """It gives back at most what was put into its spring and its mass."""
    lever2 = LEVER**2
    operator = {"mass_kg": mass, "damping_n_s_m": damping, "stiffness_n_m": stiffness, "strength_n": strength}
    held = plant(gear={"backlash_rad": gap}, operator=HAND | operator)
    held.place(start, start, spin, speed)

    def kept_j() -> float:
        truth = held.truth()
        stretched = abs(truth.arm_rad)
        bends = min(stretched, strength / (stiffness * LEVER)) if stiffness > 0.0 else 0.0
        spring_j = lever2 * stiffness * bends**2 / 2.0 + strength * LEVER * (stretched - bends if stiffness else 0.0)
        return spring_j + 0.5 * lever2 * mass * truth.arm_rad_s**2

    began = kept_j()
    # at the brink of its strength the hand is off by what its spring gains in one step: (step times frequency)^2
    slack_j = 1e-3 * (began + held.energy().stored_j) + 1e-12
    for _ in range(40):
        held.advance(OPEN, 0.0, 100)
        # where the stage is off, all that is supplied comes from the hand
        assert held.energy().supplied_j <= began - kept_j() + slack_j


def test_master_and_slave_are_two_plants_that_share_nothing_but_the_bench() -> None:
    """The slave's set point follows the master's angle; what the slave leans on shows in its own truth."""
    master = plant(friction={"viscous_n_m_s_rad": 1e-3}, operator=HAND | {"reach_rad": 0.8, "reach_duration_s": 0.5})
    slave = plant(
        friction={"viscous_n_m_s_rad": 1e-3},
        wall={"present": True, "angle_rad": 0.3, "stiffness_n_m_rad": 1000.0, "damping_n_m_s_rad": 1.0},
    )
    for _ in range(1500):
        error = master.truth().rotor_rad - slave.truth().rotor_rad
        slave.advance(VOLTAGE, float(np.clip(20.0 * error, -0.3, 0.3)), 10)
        master.advance(VOLTAGE, 0.0, 10)
    assert master.truth().arm_rad == pytest.approx(0.8, abs=1e-3)  # it does not feel the wall
    assert slave.truth().leant_n_m == pytest.approx(-0.3 / duty_for_torque(1.0), rel=1e-3)
    assert slave.truth().hand_n_m == 0.0
