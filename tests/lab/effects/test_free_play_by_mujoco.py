"""Free play as a simulator of others has it: an arm that hangs behind a motor within the range of a hinge."""

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS

mujoco = pytest.importorskip("mujoco", reason="not installed; pip install --constraint constraints.txt '.[test]'")

GAP_RAD, STEP_S, EVERY, SECONDS = 0.06, 2e-4, 25, 12.0
ARM_KG, ARM_M = 0.6, 0.2
JOINT = f"""
<mujoco><compiler angle="radian"/><option timestep="{STEP_S}" integrator="implicitfast"/><worldbody><body>
<joint name="motor" type="hinge" axis="0 1 0" frictionloss="0.15" damping="0.05" armature="0.01"/>
<inertial pos="0 0 0" mass="0.01" diaginertia="1e-5 1e-5 1e-5"/>
<body><joint type="hinge" axis="0 1 0" limited="true" range="{-GAP_RAD / 2} {GAP_RAD / 2}" solreflimit="0.002 1"/>
<inertial pos="0 0 {-ARM_M}" mass="{ARM_KG}" diaginertia="1e-4 1e-4 1e-4"/></body>
</body></worldbody><actuator><motor joint="motor"/></actuator></mujoco>
"""
WAVES = ((1.05, 0.1), (0.7, 0.25), (0.7, 0.25), (0.5, 0.5), (0.35, 1.0), (0.9, 0.4))  # amplitude [rad], frequency [Hz]


def recorded(number: int, amplitude_rad: float, hertz: float) -> Recording:
    """A servo follows a sine; what is recorded is the motor side and its torque."""
    model = mujoco.MjModel.from_xml_string(JOINT)
    data, rows = mujoco.MjData(model), []
    for step in range(round(SECONDS / STEP_S)):
        phase = 2.0 * np.pi * hertz * step * STEP_S
        wanted = amplitude_rad * np.array([np.sin(phase), 2.0 * np.pi * hertz * np.cos(phase)])
        data.ctrl[0] = 30.0 * (wanted[0] - data.qpos[0]) + 1.2 * (wanted[1] - data.qvel[0])
        if step % EVERY == 0:
            rows.append((step * STEP_S, data.qpos[0], data.ctrl[0]))
        mujoco.mj_step(model, data)
    time_s, position_rad, torque_n_m = np.array(rows).T
    channels = {"time_s": time_s, "position_rad": position_rad, "torque_n_m": torque_n_m}
    return Recording(f"t{number}", "sines", {}, channels)


def test_its_gap_is_found_and_leaves_next_to_nothing():
    made = [recorded(number, *wave) for number, wave in enumerate(WAVES)]
    fit = fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS))
    found = fit_effects(fit, [*fit.names, "backlash"])
    assert found.shapes["backlash"][0] == pytest.approx(GAP_RAD, rel=0.05)
    assert held_out(found).relative < 0.1 * held_out(fit).relative
