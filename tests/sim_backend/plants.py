"""Plants to test with: the simplest joint, to which each test adds what it is about."""

from math import pi
from typing import Any

from sim_backend.mechanisms.motor.motor import VOLTAGE
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import Plant

RATIO = 10.0
K = 0.04  # torque constant [N m/A]
RESISTANCE = 2.0
ROTOR = 2e-5
ARM = 0.004
SUPPLY = 20.0
G = 9.80665

SIMPLEST: dict[str, dict[str, Any]] = {
    "motor": {"resistance_ohm": RESISTANCE, "torque_constant_n_m_a": K, "rotor_inertia_kg_m2": ROTOR},
    "supply": {"voltage_v": SUPPLY},
    "gear": {"ratio": RATIO, "stiffness_n_m_rad": 1000.0, "damping_n_m_s_rad": 1.0},
    "arm": {"length_m": 0.3, "inertia_kg_m2": ARM},
    "encoder": {"counts_per_turn": 4096, "speed_window_s": 5e-3},
}


def parameters(**tables: dict[str, Any]) -> PlantParameters:
    """No friction, no free play, no load, no randomness; the tables given are added."""
    merged = {name: dict(table) for name, table in SIMPLEST.items()}
    for name, table in tables.items():
        merged[name] = merged.get(name, {}) | table
    return PlantParameters.from_dict(merged)


def plant(seed: int = 0, step_s: float = 1e-4, **tables: dict[str, Any]) -> Plant:
    return Plant(parameters(**tables), seed, step_s)


def run(plant: Plant, duty: float, duration_s: float) -> None:
    plant.advance(VOLTAGE, duty, round(duration_s / plant.step_s))


def duty_for_torque(joint_n_m: float) -> float:
    """Duty that makes a torque at the joint while the motor stands."""
    return joint_n_m / (RATIO * K) * RESISTANCE / SUPPLY


def settled_speed(plant: Plant, duty: float, duration_s: float = 5.0) -> float:
    """Joint speed after so long at a duty [rad/s]."""
    run(plant, duty, duration_s)
    return plant.truth().rotor_rad_s


def rpm(joint_rad_s: float, ratio: float = RATIO) -> float:
    return joint_rad_s * ratio * 60.0 / (2.0 * pi)
