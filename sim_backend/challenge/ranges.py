"""What a drawn joint may be: every quantity, its range, and why that range."""

from dataclasses import dataclass
from math import exp, log
from typing import Literal

import numpy as np


@dataclass(frozen=True)
class Range:
    """A range to draw from.

    Attributes:
        low, high: its ends, in `unit`.
        unit: SI; "1" for a plain number.
        spread: "even", or "log" where the ends are far apart.
    """

    low: float
    high: float
    unit: str
    reason: str
    spread: Literal["even", "log"] = "even"

    def at(self, share: float) -> float:
        """The value at a share of the range, 0 .. 1."""
        if self.spread == "log":
            return exp(log(self.low) + share * (log(self.high) - log(self.low)))
        return self.low + share * (self.high - self.low)

    def draw(self, random: np.random.Generator) -> float:
        """A value from the range."""
        return self.at(float(random.random()))


VOLTAGES = (12.0, 24.0, 36.0, 48.0)  # what supplies are sold for
COUNTS = (2048.0, 4096.0, 8192.0, 16384.0)  # incremental encoders and resolver converters, per motor turn
DUTY_COUNTS = (1000.0, 2048.0, 4096.0)  # timers of 20 kHz stages

SESSION_S = 250.0  # of motion, over which a joint warms
CURRENT_SHARE = 0.45  # of the peak current, root mean square in that time: a fifth of the peak's heat
HOUSING_RISE = f"rise of the housing in {SESSION_S:g} s at {CURRENT_SHARE:.0%} of the peak current"

JOINT: dict[str, Range] = {
    "arm length": Range(0.2, 0.5, "m", "bench-top joints; the paper's needs 0.5 m", "log"),
    "arm mass": Range(0.1, 0.4, "kg", "aluminium profile of that length"),
    "arm inertia over m l2 / 3": Range(0.8, 1.5, "1", "a rod about its end, with a hub and a counterweight"),
    "centre of mass over length": Range(0.05, 0.3, "1", "where the arm is not balanced, as half of them are"),
    "heaviest load": Range(0.05, 0.25, "kg", "the paper hangs 0.1 kg", "log"),
    "top speed": Range(2.5, 4.5, "rad/s", "servos of this size: 30 to 60 rpm at the joint"),
    "gear ratio": Range(12.0, 50.0, "1", "small geared servos", "log"),
    "gear stiffness": Range(1000.0, 4000.0, "N m/rad", "steel spur and planetary gears of this size", "log"),
    "gear damping ratio": Range(0.05, 0.2, "1", "material and oil film"),
    "free play": Range(5e-4, 3e-3, "rad", "3 to 10 arc minutes, data sheets of planetary gears", "log"),
    "rotor inertia over arm's": Range(0.2, 1.2, "1", "through the gear, with load; designers aim at 1", "log"),
    "Coulomb over gravity": Range(0.06, 0.25, "1", "the paper: 60 of 490 mA; Rhoban/bam: 0.05 to 0.3", "log"),
    "static over Coulomb": Range(1.1, 1.8, "1", "the paper: 100 / 60 mA; Armstrong et al. 1994: 1.1 to 2"),
    "Stribeck speed": Range(0.1, 0.5, "rad/s", "the paper: 0.25 at the joint; Rhoban/bam: 0.1 to 1", "log"),
    "Stribeck exponent": Range(1.0, 2.0, "1", "Armstrong et al. 1994: 0.5 to 2"),
    "viscous over Coulomb at top speed": Range(0.3, 1.2, "1", "the paper: 0.7"),
    "arm-side over drive-side friction": Range(0.02, 0.08, "1", "ball bearings behind the gear"),
    "back-EMF over supply at top speed": Range(0.15, 0.4, "1", "leaves voltage for current"),
    "ohmic drop over supply at peak torque": Range(0.2, 0.4, "1", "leaves voltage for speed"),
    HOUSING_RISE: Range(
        3.0, 15.0, "K", "if all heat stayed there; recordings load it less and show less; Rhoban/bam: 28 to 40 degC"
    ),
    "room": Range(15.0, 30.0, "degC", "laboratories"),
    "static scatter": Range(0.0, 0.02, "1", "stop to stop; the paper's 25 steps allow 0.02"),
    "Coulomb scatter": Range(0.0, 0.02, "1", "along the path; EMPS repeats within 0.05"),
}  # fmt: skip

DATA_SHEET: dict[str, Range] = {
    "resistance_ohm": Range(-0.05, 0.05, "1", "motor catalogues: 5 to 10 %"),
    "torque_constant_n_m_a": Range(-0.05, 0.05, "1", "motor catalogues: 5 to 10 %"),
    "rotor_inertia_kg_m2": Range(-0.1, 0.1, "1", "motor catalogues: typical value"),
    "length_m": Range(-0.003, 0.003, "1", "a ruler"),
    "mass_kg": Range(-0.005, 0.005, "1", "kitchen scales"),
    "inertia_kg_m2": Range(-0.1, 0.1, "1", "from a drawing"),
    "backlash_rad": Range(0.0, 0.3, "1", "data sheets give the most that is shipped"),
}
"""How far the value that the owner knows is from the true one, as a share of it."""

GEAR_SHEET: dict[str, Range] = {
    "stiffness_n_m_rad": Range(-0.2, 0.2, "1", "gear catalogues: typical value"),
}
"""The same, drawn from a stream of its own: what else is drawn stays what it was."""
