"""Rigs drawn at random round the one of the paper, so that nothing is tuned to one."""

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.json_types import Value

# of the preset `paper`, at the shaft where each acts
DRIVE_SIDE = {"coulomb_n_m": 3.0e-3, "static_n_m": 5.0e-3, "viscous_n_m_s_rad": 1.05e-4}
ARM_SIDE = {"coulomb_n_m": 5.0e-3, "static_n_m": 6.0e-3, "viscous_n_m_s_rad": 1.0e-3}
GAP_RAD = 0.01
FRICTION = (0.5, 2.0)  # times
GAP = (0.0, 3.0)  # times
ASYMMETRY = 0.2  # either way
BITS = (10, 14)  # of the encoder


def drawn_rig(configuration: BenchConfiguration, seed: int) -> BenchConfiguration:
    """One rig: friction, free play, asymmetry and encoder drawn; the owner knows the gap and the encoder alone."""
    generator = np.random.default_rng(seed)
    low, high = np.log(FRICTION)
    drive_side, arm_side = (float(np.exp(generator.uniform(low, high))) for _ in range(2))
    gap_rad = GAP_RAD * float(generator.uniform(*GAP))
    asymmetry = float(generator.uniform(-ASYMMETRY, ASYMMETRY))
    counts = float(2 ** generator.integers(BITS[0], BITS[1] + 1))
    plant: dict[str, Value] = {
        "friction": {name: drive_side * value for name, value in DRIVE_SIDE.items()},
        "arm_friction": {name: arm_side * value for name, value in ARM_SIDE.items()},
        "gear": {"backlash_rad": gap_rad},
        "coulomb_asymmetry": {"fraction": asymmetry},
        "encoder": {"counts_per_turn": counts},
    }
    rig = configuration.rig.model_copy(
        update={
            "name": f"{configuration.rig.name}, drawn {seed}",
            "gear": configuration.rig.gear.model_copy(update={"backlash_rad": gap_rad}),
            "sensor": configuration.rig.sensor.model_copy(update={"counts_per_turn": counts}),
        }
    )
    drive = SimulatedDriveSettings(plant=plant, seed=seed)
    return configuration.model_copy(update={"rig": rig, "drive": drive})
