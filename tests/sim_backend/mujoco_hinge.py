"""A hinge of MuJoCo with what it shares with the plant: armature, damping, frictionloss, gravity."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def hinge(mujoco: Any, step_s: float, inertia: float, mass: float, length: float, damping: float, dry: float) -> Any:
    """An arm without mass of its own, a point mass at its tip; angle 0 is down, positive as the plant's."""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>
          <option timestep="{step_s}" gravity="0 0 -9.80665" integrator="implicitfast" tolerance="1e-14">
            <flag contact="disable"/>
          </option>
          <worldbody><body>
            <joint type="hinge" axis="0 -1 0" armature="{inertia}" damping="{damping}" frictionloss="{dry}"
                   solreffriction="{2.0 * step_s} 1" solimpfriction="0.9999 0.9999 0.001 0.5 2"/>
            <inertial pos="0 0 {-length}" mass="{mass}" diaginertia="1e-9 1e-9 1e-9"/>
          </body></worldbody>
        </mujoco>"""
    )


def swing(mujoco: Any, model: Any, angle_rad: float, steps: int) -> NDArray[np.float64]:
    """Angle after each step, from rest at an angle; by the C rollout, on one core."""
    from mujoco import rollout

    data = mujoco.MjData(model)
    data.qpos[0] = angle_rad
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.zeros((1, mujoco.mj_stateSize(model, kind)))
    mujoco.mj_getState(model, data, state[0], kind)
    with rollout.Rollout(nthread=1) as roll:
        states, _ = roll.rollout(model, data, state, nstep=steps)
    return np.asarray(states[0, :, 1])
