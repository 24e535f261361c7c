"""Mechanisms that textbooks on servo drives and friction name; sizes near 1 are large ones.

Sources: Armstrong-Helouvry, Dupont, Canudas de Wit 1994; Bittencourt, Gunnarsson 2012; Krause, Wasynczuk, Sudhoff 2002.
"""

from math import pi

import numpy as np

from sim_backend.second_plant.mechanism import Mechanism, Scales, table


def _sign(random: np.random.Generator) -> float:
    return float(random.choice([-1.0, 1.0]))


def _backlash(size: float, s: Scales, _: np.random.Generator) -> dict[str, float]:
    """Flanks so stiff that their own resonance lies beyond what a drive records, damped by the oil between them."""
    rate = 2.0 * pi * 250.0
    return {
        "gap_rad": 0.02 * size,
        "stiffness_n_m_rad": s.arm_kg_m2 * rate**2,
        "coupling_n_m_s": 0.4 * s.arm_kg_m2 * rate,
    }


def _elasticity(size: float, s: Scales, _: np.random.Generator) -> dict[str, float]:
    """The arm with half of the load swings at 8 Hz on the held motor, at size 1."""
    rate = 2.0 * pi * 8.0 / size**0.5
    return {"stiffness_n_m_rad": s.arm_kg_m2 * rate**2, "coupling_n_m_s": 0.1 * s.arm_kg_m2 * rate}


def _periodic(size: float, _: Scales, random: np.random.Generator) -> dict[str, float]:
    return {"periodic_share": 0.4 * size, "periodic_phase_rad": float(random.uniform(0.0, 2.0 * pi))}


def _cogging(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    return {"cogging_n_m": 0.4 * size * s.coulomb_n_m, "cogging_per_turn": float(random.choice([1, 2, 3, 6, 12]))}


def _spring(size: float, s: Scales, random: np.random.Generator) -> dict[str, float]:
    return {"spring_n_m_rad": 0.5 * size * s.coulomb_n_m, "spring_zero_rad": float(random.uniform(-0.5, 0.5))}


TEXTBOOK = table(
    Mechanism(
        "asymmetric_coulomb",
        "Coulomb friction differs by direction",
        lambda size, _s, draw: {"coulomb_asymmetry": 0.3 * size * _sign(draw)},
        3.0,
    ),
    Mechanism(
        "asymmetric_viscous",
        "viscous friction differs by direction",
        lambda size, _s, draw: {"viscous_asymmetry": 0.5 * size * _sign(draw)},
        1.8,
    ),
    Mechanism(
        "square_drag",
        "drag with the square of speed",
        lambda size, s, _: {"drag_n_m_s2": 0.7 * size * s.coulomb_n_m / s.top_rad_s**2},
    ),
    Mechanism(
        "tooth_loss",
        "Coulomb friction on the tooth-normal force",
        lambda size, _s, _: {"tooth_loss": 0.15 * size},
        4.0,
    ),
    Mechanism(
        "tooth_loss_square",
        "tooth friction that grows with the square of the load",
        lambda size, s, _: {"tooth_loss_square_1_n_m": 0.15 * size / s.moment_n_m},
        4.0,
    ),
    Mechanism(
        "bearing_loss",
        "bearing friction with the weight carried",
        lambda size, s, _: {"bearing_loss_n_m_kg": 0.6 * size * s.coulomb_n_m / s.heaviest_kg},
    ),
    Mechanism(
        "back_driving_loss",
        "tooth friction only while the load drives the gear",
        lambda size, _s, _: {"back_driving_loss": 0.2 * size},
        3.0,
    ),
    Mechanism(
        "quadrant_coulomb",
        "teeth rub more while they drive than while they hold back",
        lambda size, s, _: {"quadrant_n_m": 0.3 * size * s.coulomb_n_m},
        2.0,
    ),
    Mechanism(
        "cold_coulomb",
        "Coulomb friction falls with temperature",
        lambda size, _s, _: {"coulomb_per_k": -0.012 * size},
        2.5,
        ("temperature",),
    ),
    Mechanism(
        "lubricant",
        "viscosity by Arrhenius' law",
        lambda size, _s, _: {"lubricant_k": 4000.0 * size},
        2.0,
        ("temperature",),
    ),
    Mechanism(
        "running_in",
        "friction falls over the session, whatever the temperature",
        lambda size, _s, draw: {"warm_up": 0.6 * size, "warm_up_s": float(draw.uniform(300.0, 1500.0))},
        needs=("session",),
    ),
    Mechanism("eccentric_gear", "friction goes with the motor's turn", _periodic, 2.0),
    Mechanism("cogging", "slots hold the magnets", _cogging),
    Mechanism("spring", "a cable acts as a spring", _spring),
    Mechanism(
        "turned_centre",
        "centre of mass beside the arm's axis",
        lambda size, _s, draw: {"centre_rad": 0.25 * size * _sign(draw)},
        3.0,
    ),
    Mechanism(
        "saturation",
        "iron saturates: less torque per ampere",
        lambda size, s, _: {"saturation_a": 1.6 * s.peak_a / size**0.5},
        3.0,
    ),
    Mechanism(
        "hot_winding",
        "copper resists more as it warms",
        lambda size, _s, _: {"copper_per_k": 0.008 * size},
        2.0,
        ("temperature", "voltage"),
    ),
    Mechanism(
        "long_bristles",
        "pre-sliding over a visible distance",
        lambda size, s, _: {"bristle_rad": s.bristle_rad + 0.03 * size},
    ),
    Mechanism("backlash", "play between the teeth", _backlash),
    Mechanism("twist", "gear and shaft twist", _elasticity),
    Mechanism("lag", "friction level lags behind speed", lambda size, _s, _: {"lag_s": 0.05 * size}),
    Mechanism(
        "ageing_contact",
        "static friction grows with the time at rest",
        lambda size, s, _: {"dwell_n_m": 0.3 * size * s.coulomb_n_m, "dwell_s": 0.1},
        needs=("starts",),
    ),
    Mechanism(
        "quick_breakaway",
        "static friction falls with the rate of the torque",
        lambda size, s, _: {"rate_share": 0.4 * size, "rate_n_m_s": 2.0 * s.coulomb_n_m},
        2.0,
        ("starts",),
    ),
    Mechanism(
        "eccentric_encoder",
        "encoder disc off its centre",
        lambda size, s, draw: {"eccentricity_rad": 0.1 * size * _sign(draw) / s.turns},
        8.0,
    ),
    Mechanism(
        "sensor_gain",
        "current sensor differs by sign",
        lambda size, _s, draw: {"current_gain": 0.08 * size * _sign(draw)},
        5.0,
        ("current",),
    ),
    Mechanism(
        "blanking",
        "dead time of the half bridges",
        lambda size, s, _: {"dead_time_v": 0.8 * size * s.resistance_ohm * s.coulomb_n_m / s.torque_per_a},
        needs=("voltage",),
    ),
    Mechanism(
        "sag",
        "the source has a resistance",
        lambda size, s, _: {"source_ohm": 0.6 * size * s.resistance_ohm},
        needs=("voltage", "nominal"),
    ),
    Mechanism(
        "emf_sheet",
        "the data sheet's back-EMF constant is off",
        lambda size, s, draw: {"emf_per_rad_s": s.emf_per_rad_s * (1.0 + 0.2 * size * _sign(draw))},
        3.0,
        ("estimate",),
    ),
)
