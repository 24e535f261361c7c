"""The plant against MuJoCo: the same hinge, swinging and driven, without friction and with viscous friction."""

import mujoco
import numpy as np
import pytest

from sim_backend.second_plant.physics import GRAVITY_M_S2
from sim_backend.second_plant.simulate import TICK_S, run
from tests.second_plant.bench import CONTROL, PLAIN, open_loop, seconds

LENGTH_M = 0.4
MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{gravity}" integrator="RK4"/>
  <worldbody><body>
    <joint name="hinge" type="hinge" axis="0 -1 0" damping="{damping}" armature="{rotor}"/>
    <inertial pos="0 0 -{length}" mass="{mass}" diaginertia="{own} {own} {own}"/>
  </body></worldbody>
  <actuator><motor joint="hinge"/></actuator>
</mujoco>
"""


@pytest.mark.parametrize("damping", [0.0, 0.08])
def test_a_driven_pendulum_moves_as_in_mujoco(damping):
    p = PLAIN._replace(viscous_n_m=damping)
    mass = p.moment_n_m / (GRAVITY_M_S2 * LENGTH_M)
    own = 0.01
    p = p._replace(arm_kg_m2=own + mass * LENGTH_M**2)
    at = seconds(4.0)
    torque = 0.8 * np.sin(2.0 * np.pi * 0.7 * at) + 0.3
    text = MODEL.format(
        step=TICK_S / 2, gravity=GRAVITY_M_S2, damping=damping, rotor=p.rotor_kg_m2, length=LENGTH_M, mass=mass, own=own
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[0] = 0.9
    expected = []
    for value in torque:
        data.ctrl[0] = value
        mujoco.mj_step(model, data, 2)
        expected.append(data.qpos[0])

    # the current follows within a millisecond; the difference stays below what that moves
    traces = run(p, CONTROL, open_loop(torque / p.torque_per_a, start_rad=0.9))

    assert np.ptp(expected) > 1.0
    assert traces.reading_rad == pytest.approx(np.array(expected), abs=5e-3)
