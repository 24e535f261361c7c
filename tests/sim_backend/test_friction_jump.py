from math import sqrt

import numpy as np
import pytest

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from tests.sim_backend.plants import RATIO, duty_for_torque, plant

COULOMB = 5e-3
DRY = {"coulomb_n_m": COULOMB, "static_n_m": COULOMB}


def test_the_joint_holds_against_the_value_of_the_state_that_it_is_in() -> None:
    joint = plant(friction=DRY, friction_jump={"fraction": 0.4, "mean_interval_s": 1e6})
    for jumped, scale in ((False, 1.0), (True, 1.4)):
        joint._state["jumped"] = jumped
        before = joint.truth().rotor_rad
        joint.advance(VOLTAGE, 0.99 * scale * duty_for_torque(RATIO * COULOMB), 2000)
        assert joint.truth().rotor_rad == pytest.approx(before, abs=1e-6)
        joint.advance(VOLTAGE, 1.02 * scale * duty_for_torque(RATIO * COULOMB), 2000)
        assert joint.truth().rotor_rad > before + 1e-5
        joint.advance(OPEN, 0.0, 30_000)


def test_flips_come_as_often_as_asked_whatever_the_grouping() -> None:
    flips, ends = [], []
    for group in (50, 100):
        joint = plant(seed=4, friction=DRY, friction_jump={"fraction": 0.4, "mean_interval_s": 0.2})
        states = []
        for _ in range(1_000_000 // group):
            joint.advance(OPEN, 0.0, group)
            states.append(bool(joint._state["jumped"][0]))
        flips.append(int(np.count_nonzero(np.diff(np.array(states, dtype=int)))))
        ends.append(states[-1])
    assert ends[0] == ends[1]
    wanted = 100.0 / 0.2
    # a Poisson count; flips within a group of 5 or 10 ms, one in 40 or 20, are not seen
    assert flips[0] == pytest.approx(0.97 * wanted, abs=4.0 * sqrt(wanted))
    assert flips[1] == pytest.approx(0.95 * wanted, abs=4.0 * sqrt(wanted))


def test_it_takes_nothing_from_the_other_randomness() -> None:
    scatter = {"static_fraction": 0.05, "coulomb_fraction": 0.05}
    joints = [plant(seed=2, friction=DRY, scatter=scatter, friction_jump={"fraction": f}) for f in (0.0, 1e-9)]
    for joint in joints:
        for duty in (0.3, -0.3, 0.3):
            joint.advance(VOLTAGE, duty, 5000)
            joint.advance(OPEN, 0.0, 5000)
    assert joints[0]._state["random"] == joints[1]._state["random"]
    assert joints[0].truth().rotor_rad == pytest.approx(joints[1].truth().rotor_rad, rel=1e-6)
