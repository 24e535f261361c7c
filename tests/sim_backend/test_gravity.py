from math import pi, sin, sqrt

import pytest

from sim_backend.mechanisms.motor.motor import OPEN
from tests.sim_backend.plants import ARM, G, plant

LOAD_KG, LENGTH_M = 0.2, 0.3
FREE_ARM = {"backlash_rad": 6.0}  # the arm swings inside the free play, without the rotor
INERTIA = ARM + LOAD_KG * LENGTH_M**2
MOMENT = LOAD_KG * G * LENGTH_M


def _period_s(swinging: object, start_rad: float) -> float:
    """Twice the time between two crossings of zero."""
    crossings = []
    before = start_rad
    for step in range(40_000):
        swinging.advance(OPEN, 0.0, 1)  # type: ignore[attr-defined]
        now = swinging.truth().arm_rad  # type: ignore[attr-defined]
        if before * now < 0.0:
            crossings.append((step + before / (before - now)) * 1e-4)
        before = now
    return 2.0 * (crossings[-1] - crossings[0]) / (len(crossings) - 1)


def test_pendulum_swings_with_the_period_of_theory() -> None:
    swinging = plant(gear=FREE_ARM, load={"mass_kg": LOAD_KG})
    swinging.place(0.0, 0.1)
    amplitude = 1.0 + 0.1**2 / 16.0  # first term of the series of the exact period
    assert _period_s(swinging, 0.1) == pytest.approx(2.0 * pi * sqrt(INERTIA / MOMENT) * amplitude, rel=1e-5)


def test_balanced_load_has_weight_and_inertia_but_no_moment() -> None:
    still = plant(load={"mass_kg": LOAD_KG, "balanced": True})
    still.place(1.0, 1.0)
    still.advance(OPEN, 0.0, 1000)
    assert still.truth().arm_rad == 1.0
    turning = plant(gear=FREE_ARM, load={"mass_kg": LOAD_KG, "balanced": True}, spring={"stiffness_n_m_rad": 2.0})
    turning.place(0.0, 0.1)
    assert _period_s(turning, 0.1) == pytest.approx(2.0 * pi * sqrt(INERTIA / 2.0), rel=1e-5)


def test_arm_comes_to_rest_where_its_centre_of_mass_is_lowest() -> None:
    hanging = plant(
        gear=FREE_ARM, load={"mass_kg": LOAD_KG}, arm_friction={"viscous_n_m_s_rad": 0.1},
        centre_of_mass={"angle_rad": 0.2},
    )  # fmt: skip
    hanging.advance(OPEN, 0.0, 200_000)
    assert hanging.truth().arm_rad == pytest.approx(-0.2, abs=1e-9)


def test_spring_and_gravity_share_the_arm() -> None:
    hanging = plant(
        gear=FREE_ARM, load={"mass_kg": LOAD_KG}, arm_friction={"viscous_n_m_s_rad": 0.1},
        spring={"stiffness_n_m_rad": 0.5, "rest_rad": 1.0},
    )  # fmt: skip
    hanging.advance(OPEN, 0.0, 200_000)
    angle = hanging.truth().arm_rad
    assert 0.0 < angle < 1.0
    assert MOMENT * sin(angle) == pytest.approx(0.5 * (1.0 - angle), rel=1e-9)


def test_arms_own_mass_pulls_where_it_is_not_balanced() -> None:
    swinging = plant(gear=FREE_ARM, arm={"mass_kg": 0.1, "centre_of_mass_m": 0.15})
    swinging.place(0.0, 0.1)
    wanted = 2.0 * pi * sqrt(ARM / (0.1 * G * 0.15)) * (1.0 + 0.1**2 / 16.0)
    assert _period_s(swinging, 0.1) == pytest.approx(wanted, rel=1e-5)
