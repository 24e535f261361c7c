"""The plant against MuJoCo, on the part that both can do."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from sim_backend.mechanisms.motor.motor import OPEN
from tests.sim_backend.mujoco_hinge import hinge, swing
from tests.sim_backend.plants import ARM, RATIO, ROTOR, plant

mujoco = pytest.importorskip("mujoco", reason="not installed; pip install --constraint constraints.txt '.[test]'")

MASS, LENGTH, START_RAD, STEP_S, TIME_S = 0.2, 0.3, 1.2, 1e-4, 2.0
EVERY_S = 2e-3


def _plant(step_s: float, damping: float, dry: float, geared: bool) -> NDArray[np.float64]:
    friction = {"viscous_n_m_s_rad": damping, "coulomb_n_m": dry, "static_n_m": dry}
    # with the rotor's inertia on stiff teeth, or the arm alone inside a wide free play
    gear = {"stiffness_n_m_rad": 1e5, "damping_n_m_s_rad": 10.0} if geared else {"backlash_rad": 6.0}
    arm = plant(step_s=step_s, gear=gear, load={"mass_kg": MASS}, arm_friction=friction)
    arm.place(START_RAD if geared else 0.0, START_RAD)
    angles = []
    for _ in range(round(TIME_S / EVERY_S)):
        arm.advance(OPEN, 0.0, round(EVERY_S / step_s))
        angles.append(arm.truth().arm_rad)
    return np.array(angles)


def _mujoco(step_s: float, damping: float, dry: float, geared: bool) -> NDArray[np.float64]:
    inertia = ARM + (RATIO**2 * ROTOR if geared else 0.0)
    model = hinge(mujoco, step_s, inertia, MASS, LENGTH, damping, dry)
    every = round(EVERY_S / step_s)
    return swing(mujoco, model, START_RAD, round(TIME_S / step_s))[every - 1 :: every]


@pytest.mark.parametrize("geared", [False, True])
@pytest.mark.parametrize(("damping", "dry"), [(0.0, 0.0), (0.02, 0.0), (0.0, 0.05), (0.01, 0.03)])
def test_trajectories_agree_to_the_tolerance_of_the_coarser_step(damping: float, dry: float, geared: bool) -> None:
    cases: Any = (damping, dry, geared)
    coarse, fine = _mujoco(STEP_S, *cases), _mujoco(0.5 * STEP_S, *cases)
    # a first-order scheme is off by what halving its step changes
    tolerance = np.abs(coarse - fine).max()
    assert tolerance < 5e-4
    # stiff teeth give by torque over stiffness
    given = MASS * 9.80665 * LENGTH / 1e5 if geared else 0.0
    assert np.abs(_plant(STEP_S, *cases) - coarse).max() < 2.0 * 1.1 * tolerance + given
    assert np.abs(_plant(STEP_S, *cases) - fine).max() < 1.1 * tolerance + given
