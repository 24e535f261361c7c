"""A mechanism that a joint may hide: what it changes in the physics, in proportion to a size."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

Need = Literal["temperature", "nominal", "voltage", "estimate", "current", "session", "starts"]


@dataclass(frozen=True)
class Scales:
    """What is usual in a joint: its mechanisms are measured by these.

    Attributes:
        coulomb_n_m: Coulomb friction.
        moment_n_m: weight of the arm with half of the load, at 90 degrees.
        viscous_n_m: viscous friction at 1 rad/s.
        top_rad_s: speed that trials go up to.
        peak_a, peak_v: most current of the drive, and the voltage that it takes through the winding.
        torque_per_a, emf_per_rad_s, resistance_ohm: of the motor, at the joint.
        arm_kg_m2: inertia of the arm with half of the load.
        heaviest_kg: heaviest load.
        turns: gear ratio.
        bristle_rad: pre-sliding distance.
    """

    coulomb_n_m: float
    moment_n_m: float
    viscous_n_m: float
    top_rad_s: float
    peak_a: float
    peak_v: float
    torque_per_a: float
    emf_per_rad_s: float
    resistance_ohm: float
    arm_kg_m2: float
    heaviest_kg: float
    turns: float
    bristle_rad: float


Changes = Callable[[float, Scales, np.random.Generator], dict[str, float]]


@dataclass(frozen=True)
class Mechanism:
    """One row of a table.

    Attributes:
        name: in the table.
        title: in words.
        changes: (size, scales, draw) -> fields of `Physics`.
        most: largest size that physics allows; 1 is a large one.
        needs: what recordings must hold for it to be there at all.
    """

    name: str
    title: str
    changes: Changes
    most: float = 20.0
    needs: tuple[Need, ...] = ()


def table(*rows: Mechanism) -> dict[str, Mechanism]:
    """Rows by name."""
    return {row.name: row for row in rows}
