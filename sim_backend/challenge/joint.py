"""A joint drawn at random: every part fits the others as a designer would have made them fit."""

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

from sim_backend.challenge.ranges import COUNTS, DUTY_COUNTS, HOUSING_RISE, JOINT, SESSION_S, VOLTAGES
from sim_backend.mechanisms.joint.gravity import STANDARD_GRAVITY_M_S2

Tables = dict[str, dict[str, Any]]
ACCELERATION_RAD_S2 = 20.0  # of the quickest motion that a motor is chosen for
HEAT_SHARE = 0.2  # of the peak's, over a session: the square of `CURRENT_SHARE`


@dataclass(frozen=True)
class Joint:
    """A joint, and the magnitudes that mechanisms are sized by. At the joint where nothing else is said.

    Attributes:
        tables: plant parameters, complete, without any hidden mechanism.
        ratio: motor turns per joint turn.
        heaviest_kg: the heaviest load that it is made for.
        top_rad_s: the fastest that it is made for.
        gravity_n_m: most that gravity pulls.
        coulomb_n_m: drive-side Coulomb friction.
        peak_n_m: most torque that it is made for.
        peak_a: current of that torque.
        inertia_kg_m2: of rotor, arm and heaviest load.
    """

    tables: Tables
    ratio: float
    heaviest_kg: float
    top_rad_s: float
    gravity_n_m: float
    coulomb_n_m: float
    peak_n_m: float
    peak_a: float
    inertia_kg_m2: float


class _Drawn:
    """Draws by name from the table of ranges."""

    def __init__(self, random: np.random.Generator) -> None:
        self.random = random

    def __getitem__(self, name: str) -> float:
        return JOINT[name].draw(self.random)

    def choice(self, values: tuple[float, ...]) -> float:
        return values[int(self.random.integers(len(values)))]


def draw_joint(random: np.random.Generator) -> Joint:
    """Draw a joint. The same generator state gives the same joint."""
    drawn = _Drawn(random)
    arm, loaded_kg_m2, heaviest_kg, gravity_n_m = _arm(drawn)
    top_rad_s, ratio = drawn["top speed"], drawn["gear ratio"]
    rotor_kg_m2 = drawn["rotor inertia over arm's"] * loaded_kg_m2  # at the joint
    coulomb_n_m = drawn["Coulomb over gravity"] * gravity_n_m
    friction, arm_friction, viscous_n_m = _friction(drawn, coulomb_n_m, ratio, top_rad_s)
    inertia_kg_m2 = rotor_kg_m2 + loaded_kg_m2
    peak_n_m = gravity_n_m + coulomb_n_m + viscous_n_m + inertia_kg_m2 * ACCELERATION_RAD_S2
    motor, supply, peak_a = _motor(drawn, ratio, top_rad_s, peak_n_m, rotor_kg_m2)
    tables = {
        "motor": motor,
        "supply": supply,
        "gear": _gear(drawn, ratio, rotor_kg_m2, arm["inertia_kg_m2"]),
        "arm": arm,
        "encoder": {"counts_per_turn": drawn.choice(COUNTS), "speed_window_s": 5e-3},
        "friction": friction,
        "arm_friction": arm_friction,
        "load_friction": {"driving": 0.0, "back_driving": 0.0},
        "heat": _heat(drawn, HEAT_SHARE * peak_a**2 * motor["resistance_ohm"]),
        "scatter": {
            "static_fraction": drawn["static scatter"],
            "coulomb_fraction": drawn["Coulomb scatter"],
            "coulomb_length_rad": 0.05,
        },
    }
    return Joint(
        tables, ratio, heaviest_kg, top_rad_s, gravity_n_m, coulomb_n_m, peak_n_m, peak_a, inertia_kg_m2
    )  # fmt: skip


def _arm(drawn: _Drawn) -> tuple[dict[str, float], float, float, float]:
    """Return the arm, its inertia with the heaviest load [kg m2], that load [kg], and the most gravity pulls [N m]."""
    length_m, mass_kg, heaviest_kg = drawn["arm length"], drawn["arm mass"], drawn["heaviest load"]
    balanced = bool(drawn.random.random() < 0.5)
    centre_m = drawn["centre of mass over length"] * length_m
    arm = {
        "length_m": length_m,
        "inertia_kg_m2": drawn["arm inertia over m l2 / 3"] * mass_kg * length_m**2 / 3.0,
        "mass_kg": mass_kg,
        "centre_of_mass_m": 0.0 if balanced else centre_m,
    }
    moment_kg_m = heaviest_kg * length_m + mass_kg * arm["centre_of_mass_m"]
    loaded_kg_m2 = arm["inertia_kg_m2"] + heaviest_kg * length_m**2
    return arm, loaded_kg_m2, heaviest_kg, STANDARD_GRAVITY_M_S2 * moment_kg_m


def _friction(
    drawn: _Drawn, coulomb_n_m: float, ratio: float, top_rad_s: float
) -> tuple[dict[str, float], dict[str, float], float]:
    """Return drive-side and arm-side friction, and viscous friction at top speed, at the joint [N m]."""
    static, stribeck_rad_s = drawn["static over Coulomb"], drawn["Stribeck speed"]
    exponent, viscous_n_m = drawn["Stribeck exponent"], drawn["viscous over Coulomb at top speed"] * coulomb_n_m
    behind_n_m = drawn["arm-side over drive-side friction"] * coulomb_n_m
    drive = {
        "coulomb_n_m": coulomb_n_m / ratio,
        "static_n_m": static * coulomb_n_m / ratio,
        "stribeck_rad_s": stribeck_rad_s * ratio,
        "stribeck_exponent": exponent,
        "viscous_n_m_s_rad": viscous_n_m / top_rad_s / ratio**2,
        "growth_per_n": 0.0,
    }
    arm = {
        "coulomb_n_m": behind_n_m,
        "static_n_m": 1.2 * behind_n_m,
        "stribeck_rad_s": stribeck_rad_s,
        "viscous_n_m_s_rad": behind_n_m / top_rad_s,
    }
    return drive, arm, viscous_n_m


def _motor(
    drawn: _Drawn, ratio: float, top_rad_s: float, peak_n_m: float, rotor_kg_m2: float
) -> tuple[dict[str, float], dict[str, float], float]:
    """Return motor, supply, and the current of the peak torque [A]."""
    voltage_v = drawn.choice(VOLTAGES)
    constant = drawn["back-EMF over supply at top speed"] * voltage_v / (ratio * top_rad_s)
    peak_a = peak_n_m / (ratio * constant)
    motor = {
        "resistance_ohm": drawn["ohmic drop over supply at peak torque"] * voltage_v / peak_a,
        "torque_constant_n_m_a": constant,
        "rotor_inertia_kg_m2": rotor_kg_m2 / ratio**2,
    }
    return motor, {"voltage_v": voltage_v, "duty_counts": drawn.choice(DUTY_COUNTS)}, peak_a


def _gear(drawn: _Drawn, ratio: float, rotor_kg_m2: float, arm_kg_m2: float) -> dict[str, float]:
    stiffness = drawn["gear stiffness"]
    reduced_kg_m2 = 1.0 / (1.0 / rotor_kg_m2 + 1.0 / arm_kg_m2)
    return {
        "ratio": ratio,
        "backlash_rad": drawn["free play"],
        "stiffness_n_m_rad": stiffness,
        "damping_n_m_s_rad": 2.0 * drawn["gear damping ratio"] * sqrt(stiffness * reduced_kg_m2),
    }


def _heat(drawn: _Drawn, loss_w: float) -> dict[str, float]:
    """Return thermal masses that such a loss warms as far as was drawn, the winding well before the housing."""
    room_c, warming_k = drawn["room"], drawn[HOUSING_RISE]
    housing_j_k = loss_w * SESSION_S / warming_k
    return {
        "present": True,
        "ambient_c": room_c,
        "start_c": room_c,
        "winding_j_k": 0.1 * housing_j_k,
        "housing_j_k": housing_j_k,
        "winding_to_housing_k_w": 0.5 * warming_k / loss_w,
        "housing_to_ambient_k_w": 4.0 * warming_k / loss_w,
    }
