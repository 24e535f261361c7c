"""Rigs drawn at random: a joint, its wires, and what its owner says of it, right or wrong."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from sim_backend.challenge.joint import Tables, draw_joint

LEAST_ROBOCLAW_A = 1.0  # of the motor's peak: nobody puts one of 0.2 A on a controller that counts in 10 mA
WIRES = ("roboclaw", "modbus", "canopen")
FAULTS = ("", "", "", "", "", "", "", "encoder unplugged", "motor unplugged", "angle misjudged")
"""What is wrong with three rigs in ten, beside what the owner says."""


@dataclass(frozen=True)
class DrawnRig:
    """One rig.

    Attributes:
        wire: kind of its drive.
        tables: of the plant behind it.
        fault: what is wrong; "" where nothing is.
        answers: what the owner says, by the key of the question; None: "not known".
        first_kg: weight that is hung as a trial.
        seen_rad: by how much the owner misjudges an angle.
        down_rad: by how much "straight down" is not.
    """

    wire: str
    tables: Tables
    fault: str
    answers: dict[str, float | None]
    first_kg: float
    seen_rad: float
    down_rad: float


def draw_rig(number: int, seed: int) -> DrawnRig:
    """A rig; the same number and seed give the same one."""
    random = np.random.default_rng([seed, number])
    joint, wire = draw_joint(random), WIRES[number % len(WIRES)]
    while wire == "roboclaw" and joint.peak_a < LEAST_ROBOCLAW_A:
        joint = draw_joint(random)
    tables = {name: dict(table) for name, table in joint.tables.items()}
    tables["wiring"] = _wiring(random, wire)
    loss = float(random.uniform(0.0, 0.2))
    tables["load_friction"] = {"driving": loss, "back_driving": loss}
    sag = float(random.uniform(0.0, 0.05))
    tables["supply"]["source_resistance_ohm"] = sag * tables["motor"]["resistance_ohm"]
    fault = str(random.choice(FAULTS))
    length_m, load_kg = tables["arm"]["length_m"], round(joint.heaviest_kg, 3)
    answers = {
        "arm_length_m": round(length_m, 3),
        "gear_ratio": _said(random, joint.ratio, (2.5, 0.4)),
        "counts_per_turn": _said(random, tables["encoder"]["counts_per_turn"], (0.25, 4.0)),
        "motor_current_a": float(f"{1.2 * joint.peak_a:.3g}"),
        "load_kg": load_kg,
        "hand_angle_deg": 45.0 if fault == "angle misjudged" else 90.0,
    }
    first_kg = round(load_kg * float(random.uniform(0.3, 0.9)), 3)
    seen_rad, down_rad = (float(random.normal(0.0, 0.015)) for _ in range(2))
    return DrawnRig(wire, tables, fault, answers, first_kg, seen_rad, down_rad)


def _wiring(random: np.random.Generator, wire: str) -> dict[str, Any]:
    """Swapped leads. A CiA 402 drive commutates by its encoder: there both are swapped, or neither is."""
    motor, encoder = (bool(one) for one in random.integers(2, size=2))
    return {"motor_reversed": motor, "encoder_reversed": motor if wire == "canopen" else encoder}


def _said(random: np.random.Generator, true: float, factors: tuple[float, float]) -> float | None:
    """What the owner says of a value: true for half of them, wrong by a factor or not known for a quarter each."""
    kind = int(random.integers(4))
    if kind < 2:
        return float(true)
    return None if kind == 2 else float(true) * factors[int(random.integers(2))]
