"""Mechanisms that no list of effects has: what a bench has all the same; sizes near 1 are large ones."""

from math import pi

import numpy as np

from sim_backend.second_plant.mechanism import Mechanism, Scales, table


def _cable(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    """A loop of cable of 0.1 to 0.4 m swings at 0.8 to 1.6 Hz."""
    return {"cable_kg_m": 0.15 * size * s.moment_n_m / 9.81, "cable_rad_s": float(random.uniform(5.0, 10.0))}


def _sector(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    return {
        "sector_n_m": size * s.coulomb_n_m,
        "sector_rad": float(random.uniform(-0.4, 0.4)),
        "sector_width_rad": float(random.uniform(0.08, 0.2)),
    }


def _tip(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    """A part of the arm that swings on its own."""
    return {"tip_kg_m2": 0.4 * size * s.arm_kg_m2, "tip_rad_s": 2.0 * pi * float(random.uniform(3.0, 7.0))}


def _interpolation(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    """Harmonic error of a sine-cosine sensor, at 2 to 4 times the electrical angle."""
    pairs = float(random.choice([2, 4]))
    return {
        "interpolation_rad": 0.05 * size / s.turns / pairs,
        "interpolation_order": float(random.choice([2, 3, 4])),
        "pole_pairs": pairs,
    }


FOREIGN = table(
    Mechanism(
        "brake_hysteresis",
        "magnetic hysteresis of a parking brake",
        lambda size, s, draw: {
            "hysteresis_n_m": 0.8 * size * s.coulomb_n_m,
            "hysteresis_rad": float(draw.uniform(0.3, 1.0)),
        },
    ),
    Mechanism(
        "seal_creep",
        "lip seal that bends and creeps back",
        lambda size, s, draw: {
            "seal_n_m": size * s.coulomb_n_m,
            "seal_rad": float(draw.uniform(0.1, 0.3)),
            "seal_s": float(draw.uniform(0.2, 0.8)),
        },
    ),
    Mechanism(
        "tooth_impact",
        "teeth knock as they come into mesh",
        lambda size, s, draw: {
            "tooth_impact_n_m": 5.0 * size * s.coulomb_n_m / s.top_rad_s,
            "teeth_per_turn": float(draw.integers(17, 61)),
        },
    ),
    Mechanism("swinging_cable", "a hanging cable swings", _cable),
    Mechanism(
        "other_axis",
        "another axis loads the common supply",
        lambda size, s, _: {"other_axis_v": 0.5 * size * s.peak_v},
        needs=("voltage", "nominal"),
    ),
    Mechanism(
        "belt_creep",
        "belt slips with its tension",
        lambda size, s, _: {"creep_per_s": 0.08 * size / s.moment_n_m},
        5.0,
    ),
    Mechanism("interpolation", "position sensor errs within its period", _interpolation, 10.0),
    Mechanism(
        "housing_preload",
        "housing breathes with the room's temperature",
        lambda size, s, draw: {
            "housing_n_m": size * s.coulomb_n_m,
            "housing_s": float(draw.uniform(200.0, 700.0)),
        },
    ),
    Mechanism(
        "torque_ripple",
        "torque constant ripples with the electrical angle",
        lambda size, _s, draw: {"ripple_share": 0.25 * size, "pole_pairs": float(draw.choice([1, 2, 4]))},
        3.0,
    ),
    Mechanism("worn_sector", "a worn sector of the gear rubs", _sector),
    Mechanism("swinging_tip", "a part of the arm swings on its own", _tip, 2.0),
    Mechanism(
        "acceleration_loss",
        "friction grows with acceleration",
        lambda size, _s, _: {"acceleration_loss": 0.05 * size},
    ),
    Mechanism(
        "wandering_bias",
        "zero of the current sensor wanders",
        lambda size, s, draw: {
            "bias_a": 0.3 * size * s.coulomb_n_m / s.torque_per_a,
            "bias_s": float(draw.uniform(0.3, 2.0)),
        },
        needs=("current",),
    ),
    Mechanism(
        "rub",
        "something rubs now and then",
        lambda size, s, draw: {"rub_n_m": size * s.coulomb_n_m, "rub_s": float(draw.uniform(0.3, 1.5))},
    ),
)
