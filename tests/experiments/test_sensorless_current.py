"""Measured and estimated current side by side, on a simulated drive that measures its current."""

import numpy as np

from bench.config.configuration import default_configuration
from bench.drives.sim.settings import SimulatedDriveSettings
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
