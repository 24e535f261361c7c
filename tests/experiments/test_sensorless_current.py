"""Measured and estimated current side by side, on a simulated drive that measures its current."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.drives.sim.settings import SimulatedDriveSettings
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants
from tests.experiments.bench_run import Ran

WARM = {
    "current_sensor": {"present": True},
    "heat": {"present": True, "start_c": 65.0},
    "thermal_drift": {"resistance_per_k": 0.0039},
}


def _swung(rig_motor, plant=WARM):
    plain = default_configuration()
    rig = plain.rig.model_copy(update={"motor": plain.rig.motor.model_copy(update=rig_motor)})
    drive = SimulatedDriveSettings(seed=4, plant=plant)
    bench = plain.model_copy(update={"rig": rig, "drive": drive})
    return Ran(bench, "excitation", loads_kg=(0.05,), waveforms=("slow-sine",), repeats=1, duration_s=4.0)


def _difference(ran):
    """Of the two currents, rms over the rms of the measured one, where the joint is powered."""
    measured, estimated = ran.channel(0, "current_a"), ran.channel(0, "current_estimate_a")
    powered = ran.channel(0, "enabled") > 0.0
    gap = (estimated - measured)[powered]
    return np.sqrt(np.mean(gap**2) / np.mean(measured[powered] ** 2))


def test_the_estimate_follows_the_measured_current_when_the_winding_is_known_to_be_warm():
    # at 65 degC copper resists 16 % more
    assert _difference(_swung({"constants_at_c": 25.0})) < 0.05
    assert _difference(_swung({})) > 0.1


def test_both_forms_give_the_same_load_along_a_whole_motion():
    # (3), (5) by currents, and (7), (8) by duties; speed, supply and friction as they come
    ran = _swung({})
    constants = MotorConstants(8.0, 0.05)
    duty, speed = ran.channel(0, "duty"), 20.0 * ran.channel(0, "velocity_rad_s")
    friction_a = np.sign(speed) * (0.1 + 2e-3 * np.abs(speed))
    load_a = motor.load_current_a(motor.current_a(constants, duty, speed, 24.0), friction_a)
    load_duty = motor.load_duty(constants, duty, motor.friction_duty(constants, friction_a, speed, 24.0), speed, 24.0)
    np.testing.assert_allclose(motor.current_a(constants, load_duty, speed, 24.0), load_a, atol=1e-12)
    still = speed == 0.0
    assert np.any(still)
    assert np.any(~still)
    assert load_duty[still] == pytest.approx((duty - friction_a * 8.0 / 24.0)[still])
