from itertools import pairwise
from math import asin, exp, pi, sqrt, tan

import pytest

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from tests.sim_backend.plants import ARM, RATIO, ROTOR, duty_for_torque, plant, run

GAP = 0.02
ROTOR_AT_JOINT = RATIO**2 * ROTOR
REDUCED = 1.0 / (1.0 / ROTOR_AT_JOINT + 1.0 / ARM)


def test_free_play_is_the_gap_seen_from_the_motor() -> None:
    """The arm held fast, a rotor pushed softly to either flank: the encoder spans gap and tooth deflection."""
    torque, stiffness = 0.02, 1000.0
    held = plant(
        gear={"backlash_rad": GAP}, arm_friction={"coulomb_n_m": 1.0, "static_n_m": 1.0},
        friction={"viscous_n_m_s_rad": 1e-3},
    )  # fmt: skip
    positions = []
    for sign in (1.0, -1.0):
        run(held, sign * duty_for_torque(torque), 3.0)
        positions.append(float(held.advance(VOLTAGE, sign * duty_for_torque(torque), 10)[0]))
    count_rad = 2.0 * pi / 4096 / RATIO
    assert positions[0] - positions[1] == pytest.approx(GAP + 2.0 * torque / stiffness, abs=1.01 * count_rad)
    assert held.truth().arm_rad == 0.0


def test_inside_the_free_play_no_torque_passes() -> None:
    loose = plant(gear={"backlash_rad": GAP})
    loose.place(0.0, 0.0, rotor_rad_s=0.5)
    loose.advance(OPEN, 0.0, round(0.4 * GAP / 0.5 / 1e-4))
    truth = loose.truth()
    assert (truth.rotor_rad_s, truth.arm_rad_s, truth.contact_n_m) == (0.5, 0.0, 0.0)
    assert truth.rotor_rad == pytest.approx(0.4 * GAP, rel=1e-9)


@pytest.mark.parametrize("damping", [0.0, 0.2, 1.0])
def test_contact_conserves_momentum_and_rebounds_as_theory_says(damping: float) -> None:
    stiffness = 1000.0
    hit = plant(step_s=2e-6, gear={"backlash_rad": GAP, "damping_n_m_s_rad": damping})
    hit.place(0.009, 0.0, rotor_rad_s=1.0)
    hit.advance(OPEN, 0.0, round(0.012 / 2e-6))
    truth = hit.truth()
    assert truth.contact_n_m == 0.0
    momentum = ROTOR_AT_JOINT * truth.rotor_rad_s + ARM * truth.arm_rad_s
    assert momentum == pytest.approx(ROTOR_AT_JOINT, rel=1e-12)
    # spring and damper that cannot pull: they part when the force is zero, not when the spring is slack
    alpha = asin(damping / (2.0 * sqrt(stiffness * REDUCED)))
    rebound = exp(-tan(alpha) * (pi - 2.0 * alpha))
    assert truth.arm_rad_s - truth.rotor_rad_s == pytest.approx(rebound, rel=2e-3)


@pytest.mark.parametrize("stiffness", [1e3, 3e4, 1.3e5])
@pytest.mark.parametrize("damping", [0.0, 0.5])
@pytest.mark.parametrize("start_rad", [0.0, 2.3e-5, 7.1e-5])
def test_teeth_that_close_within_a_step_make_no_energy(stiffness: float, damping: float, start_rad: float) -> None:
    """Up to a step times frequency of 1. What Newton's method leaves over is 1e-9 of a step's way."""
    hit = plant(gear={"backlash_rad": GAP, "stiffness_n_m_rad": stiffness, "damping_n_m_s_rad": damping})
    hit.place(start_rad, 0.0, rotor_rad_s=1.0)
    began = hit.energy().stored_j
    hit.advance(OPEN, 0.0, 5000)
    truth, energy = hit.truth(), hit.energy()
    assert truth.arm_rad > 0.01
    momentum = ROTOR_AT_JOINT * truth.rotor_rad_s + ARM * truth.arm_rad_s
    assert momentum == pytest.approx(ROTOR_AT_JOINT, rel=1e-12)
    assert energy.stored_j + energy.lost_j == pytest.approx(began, rel=1e-7)
    assert energy.stored_j <= began * (1.0 + 1e-9)


def test_gear_without_free_play_pulls_as_well_as_it_pushes() -> None:
    tight = plant(gear={"damping_n_m_s_rad": 0.0})
    tight.place(1e-3, -1e-3)
    mean = 1e-3 * (ROTOR_AT_JOINT - ARM) / (ROTOR_AT_JOINT + ARM)
    period_s = 2.0 * pi * sqrt(REDUCED / 1000.0)
    twists = []
    for _ in range(4000):
        tight.advance(OPEN, 0.0, 1)
        truth = tight.truth()
        twists.append(truth.rotor_rad - truth.arm_rad)
        assert ROTOR_AT_JOINT * truth.rotor_rad + ARM * truth.arm_rad == pytest.approx(
            (ROTOR_AT_JOINT + ARM) * mean, abs=1e-12
        )
    crossings = [i + a / (a - b) for i, (a, b) in enumerate(pairwise(twists)) if a * b < 0.0]
    measured_s = 2.0 * (crossings[-1] - crossings[0]) / (len(crossings) - 1) * 1e-4
    # the midpoint rule lengthens the period by (w h)^2 / 12
    assert measured_s == pytest.approx(period_s * (1.0 + (2.0 * pi / period_s * 1e-4) ** 2 / 12.0), rel=1e-4)
    assert max(twists) == pytest.approx(2e-3, rel=1e-3)


@pytest.mark.parametrize(
    ("gap_rad", "stiffness", "damping", "pressed_rad", "speed_rad_s"),
    [(4.2e-6, 1.3e4, 780.0, 5.4e-8, -15.0), (2e-5, 6.6e3, 530.0, 8.6e-7, -7.0), (7.5e-5, 4.1e3, 940.0, 1.9e-8, -25.0)],
)
def test_teeth_that_let_go_and_meet_the_other_flank_in_one_step_make_no_energy(
    gap_rad: float, stiffness: float, damping: float, pressed_rad: float, speed_rad_s: float
) -> None:
    gear = {"backlash_rad": gap_rad, "stiffness_n_m_rad": stiffness, "damping_n_m_s_rad": damping}
    rattling = plant(gear=gear)
    rattling.place(0.5 * gap_rad + pressed_rad, 0.0, rotor_rad_s=speed_rad_s)
    began_j = rattling.energy().stored_j
    losses_j = [0.0]
    for _ in range(30):
        rattling.advance(OPEN, 0.0, 1)
        losses_j.append(rattling.energy().lost_j)
    assert losses_j[-1] + rattling.energy().stored_j == pytest.approx(began_j, rel=1e-9)
    assert all(after >= before - 1e-12 * began_j for before, after in pairwise(losses_j))
