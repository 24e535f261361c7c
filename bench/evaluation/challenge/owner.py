"""What the owner of a drawn joint knows of it, and the bench that the owner builds from that."""

from collections.abc import Mapping
from math import floor, log10

from bench.config.configuration import BenchConfiguration, parse_configuration
from bench.config.rig import CHALLENGE, Rig
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.evaluation.challenge.hidden_plant import DrawnPlant
from bench.json_types import Value

BANDWIDTH_RAD_S = 28.0  # of the position servo: stiff enough for the motions, far below the sampling rate
PERIOD_S = 0.005


def rig_of(drawn: DrawnPlant) -> Rig:
    """The rig from data sheets, drawings and a ruler: every value off by its tolerance, and rounded as they are.

    Nothing hidden is in it: it is made of the joint without its mechanisms.
    """
    tables, off = drawn.joint.tables, drawn.sheet
    motor, gear, arm = tables["motor"], tables["gear"], tables["arm"]
    constant = _sheet(motor, "torque_constant_n_m_a", off)
    return Rig.model_validate(
        {
            "name": CHALLENGE,
            "motor": {
                "resistance_ohm": _sheet(motor, "resistance_ohm", off),
                "torque_constant_n_m_a": constant,
                "back_emf_v_s_rad": constant,
                "rotor_inertia_kg_m2": _sheet(motor, "rotor_inertia_kg_m2", off),
            },
            "gear": {
                "ratio": gear["ratio"],
                "backlash_rad": _sheet(gear, "backlash_rad", off, 2),
                "stiffness_n_m_rad": _sheet(gear, "stiffness_n_m_rad", off, 2),
            },
            "arm": {
                "length_m": _sheet(arm, "length_m", off),
                "mass_kg": _sheet(arm, "mass_kg", off),
                "centre_of_mass_m": _rounded(arm["centre_of_mass_m"], 2),
                "inertia_kg_m2": _sheet(arm, "inertia_kg_m2", off),
            },
            "sensor": {"counts_per_turn": tables["encoder"]["counts_per_turn"]},
            "supply": {"voltage_v": tables["supply"]["voltage_v"]},
        }
    )


def bench_of(drawn: DrawnPlant, seed: int, without: str | None = None) -> BenchConfiguration:
    """The bench of a drawn joint: limits and servo as its owner tunes them, from what the rig says.

    Args:
        drawn: the joint and what it hides.
        seed: of the plant's scatter and noise.
        without: one of its mechanisms that is left out.
    """
    joint, rig = drawn.joint, rig_of(drawn)
    torque_per_a = (rig.motor.torque_constant_n_m_a or 0.0) * joint.ratio
    most_a = 1.6 * joint.peak_a
    stiffness = BANDWIDTH_RAD_S**2 * joint.inertia_kg_m2 / torque_per_a
    drive = SimulatedDriveSettings(seed=seed, plant=drawn.tables(without))
    values: dict[str, Value] = {
        "name": CHALLENGE,
        "rig": rig.model_dump(mode="json", exclude_none=True),
        "drive": drive.model_dump(mode="json"),
        "control": {"period_s": PERIOD_S},
        "limits": {
            "current_a": 2.0 * most_a,
            "speed_rad_s": 3.0 * joint.top_rad_s,
            "load_kg": joint.heaviest_kg,
            "temperature_c": 110.0,
        },
        "motion": {
            "speed_rad_s": 0.7 * joint.top_rad_s,
            "acceleration_rad_s2": 0.5 * joint.peak_n_m / joint.inertia_kg_m2,
        },
        "servo": {
            "proportional_a_rad": stiffness,
            "integral_a_rad_s": 0.2 * BANDWIDTH_RAD_S * stiffness,
            "derivative_a_s_rad": 0.7 * stiffness / BANDWIDTH_RAD_S,
            "current_a": most_a,
        },
        "search": {"current_step_a": 0.003 * most_a, "ceiling_a": 0.95 * most_a},
    }
    return parse_configuration(values, "the challenge's bench")


def _sheet(table: Mapping[str, float], name: str, off: dict[str, float], digits: int = 3) -> float:
    return _rounded(float(table[name]) * (1.0 + off[name]), digits)


def _rounded(value: float, digits: int) -> float:
    """To so many significant digits, as data sheets are."""
    return 0.0 if value == 0.0 else round(value, digits - 1 - floor(log10(abs(value))))
