from math import pi, sqrt

import numpy as np
import pytest

from sim_backend.mechanisms.motor.motor import OPEN
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import ARM, RATIO, ROTOR, parameters, plant

STIFFNESS, REACH = 0.9, 0.3
HOSE = {"stiffness_n_m_rad": STIFFNESS, "reach_rad": REACH}


def _torque(joint: Plant) -> float:
    """What the hose does to an arm that stands."""
    state = joint._state[0]
    return -STIFFNESS / 3.0 * float(state["hose_first_rad"] + state["hose_second_rad"] + state["hose_third_rad"])


def _turn(joint: Plant, angle_rad: float) -> float:
    """Turn by an angle at a steady crawl, without any other torque; the hose's torque there."""
    steps = 400
    speed = angle_rad / (steps * joint.step_s)
    for _ in range(steps):
        joint._state["rotor_rad_s"] = joint._state["arm_rad_s"] = speed
        joint.advance(OPEN, 0.0, 1)
    return _torque(joint)


def _heavy() -> Plant:
    """So heavy that the hose does not slow it down within a step."""
    return plant(hose=HOSE, motor={"rotor_inertia_kg_m2": 1e3}, arm={"inertia_kg_m2": 1e5})


def test_torque_along_the_first_turn_is_that_of_three_sliders() -> None:
    for angle in (0.05, 0.15, 0.25, 0.6):
        sliders = sum(min(angle, share * REACH) for share in (1 / 3, 2 / 3, 1.0))
        assert _turn(_heavy(), angle) == pytest.approx(-STIFFNESS / 3.0 * sliders, rel=1e-3)


def test_it_remembers_where_it_turned_back_and_closes_inner_loops() -> None:
    joint = _heavy()
    outer = _turn(joint, 0.2)
    inner = _turn(joint, -0.08)
    assert inner > outer  # it lets go, without having been there before
    again = _turn(joint, 0.08)
    assert again == pytest.approx(outer, rel=1e-6)  # the inner loop is closed and forgotten
    other = _heavy()
    _turn(other, 0.4)
    # at one and the same angle the torque depends on the way that led there
    assert abs(_turn(other, -0.2) - outer) > 0.3 * abs(outer)


def test_loop_takes_energy_whatever_the_speed() -> None:
    taken = []
    for steps in (1000, 8000):
        joint = _heavy()
        way = 0.5 * np.sin(np.linspace(0.0, 4.0 * pi, steps + 1))
        torques = []
        for turn in np.diff(way):
            joint._state["rotor_rad_s"] = joint._state["arm_rad_s"] = turn / joint.step_s
            joint.advance(OPEN, 0.0, 1)
            torques.append(_torque(joint))
        half = steps // 2  # the first round is not closed yet
        taken.append(-float(np.array(torques[half:]) @ np.diff(way)[half:]))
    # of a closed loop between -A and A each slider takes 4 r (A - r) k
    wanted = sum(4.0 * r * (0.5 - r) * STIFFNESS / 3.0 for r in (REACH / 3, 2 * REACH / 3, REACH))
    assert taken == pytest.approx([wanted, wanted], rel=0.01)


def test_small_swing_is_that_of_a_spring_and_loses_nothing() -> None:
    joint = plant(hose=HOSE)
    joint.place(0.05, 0.05)
    joint._state["rotor_rad_s"] = joint._state["arm_rad_s"] = 0.0
    joint._state["hose_first_rad"] = joint._state["hose_second_rad"] = joint._state["hose_third_rad"] = 0.05
    period = 2.0 * pi * sqrt((RATIO**2 * ROTOR + ARM) / STIFFNESS)
    joint.advance(OPEN, 0.0, round(period / joint.step_s))
    assert joint.truth().arm_rad == pytest.approx(0.05, rel=0.01)


def test_absent_hose_changes_no_bit() -> None:
    one, other = (Plant(parameters(hose={"stiffness_n_m_rad": 0.0, "reach_rad": reach}), 1) for reach in (0.1, 0.7))
    for joint in (one, other):
        joint.place(0.7, 0.7)
        joint.advance(OPEN, 0.0, 2000)
    assert one.truth() == other.truth()
