from math import exp

import pytest

from sim_backend.mechanisms.motor.motor import OPEN
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import RATIO, duty_for_torque, plant, run

STATIC = 8e-3
FRICTION = {"coulomb_n_m": 5e-3, "static_n_m": STATIC, "stribeck_rad_s": 2.0}
DWELL = {"rise_fraction": 0.5, "time_s": 2.0, "slip_rad": 0.5}


def _moves_at(rested: Plant, torque: float) -> bool:
    before = rested.truth().arm_rad
    for share in range(1, 21):  # gently, or the teeth swing
        run(rested, duty_for_torque(RATIO * torque * share / 20.0), 1e-3)
    return rested.truth().arm_rad != before


@pytest.mark.parametrize("rest_s", [0.1, 2.0, 30.0])
def test_static_friction_rises_with_the_time_at_rest(rest_s: float) -> None:
    wanted = STATIC * (1.0 + 0.5 * rest_s / (rest_s + 2.0))
    for factor, moves in ((0.995, False), (1.005, True)):
        rested = plant(friction=FRICTION, dwell=DWELL)
        rested.advance(OPEN, 0.0, round((rest_s - 0.02) / 1e-4))
        assert _moves_at(rested, wanted * factor) is moves


def test_arm_side_ages_on_its_own() -> None:
    held = plant(gear={"damping_n_m_s_rad": 4.0}, arm_friction=FRICTION, arm_dwell=DWELL)
    held.advance(OPEN, 0.0, 20_000)
    assert not _moves_at(held, STATIC * 1.2 / RATIO)
    assert _moves_at(held, STATIC * 1.3 / RATIO)


def test_sliding_makes_the_contact_young_again() -> None:
    """At a speed w the age relaxes to d / |w|, within a way of d."""
    sliding = plant(friction=FRICTION | {"stribeck_rad_s": 1e-3}, dwell=DWELL)
    sliding.advance(OPEN, 0.0, 50_000)
    sliding.place(0.0, 0.0, 2.0, 2.0)
    sliding._state["rest_s"] = 5.0
    way = 0.0
    for _ in range(100):
        before = sliding.truth().rotor_rad
        sliding.advance(OPEN, 0.0, 1)
        way += (sliding.truth().rotor_rad - before) * RATIO
    speed = sliding.truth().rotor_rad_s * RATIO
    age_s = float(sliding._state["rest_s"][0])
    # between the ages that the fastest and the slowest speed of this way lead to
    for bound, other in ((2.0 * RATIO, min), (speed, max)):
        renewed = exp(-way / 0.5)
        predicted = 5.0 * renewed + 0.5 / bound * (1.0 - renewed)
        assert other(age_s, predicted) == pytest.approx(predicted, rel=1e-6)


def test_bristles_break_away_later_after_a_rest() -> None:
    forces = []
    for rest_s in (0.0, 20.0):
        bristled = plant(gear={"backlash_rad": 6.0}, friction=FRICTION, dwell=DWELL, bristle={"stiffness_n_m_rad": 2.0})
        bristled.advance(OPEN, 0.0, round(rest_s / 1e-4))
        torque = 0.0
        while bristled.truth().rotor_rad_s * RATIO < 2.0:
            torque += 1e-5
            run(bristled, duty_for_torque(RATIO * torque), 1e-3)
        forces.append(torque)
    assert forces[1] / forces[0] == pytest.approx((1.0 + 0.5 * 20.0 / 22.0) / 1.1, rel=0.08)
