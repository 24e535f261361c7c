"""What the catalogue of effects calls each mechanism that a challenge may hide. For scoring only.

The simulation does not know the catalogue, and the model lab does not know the simulation. Names that the catalogue
does not have (yet) count as outside it: for these, "none of these" is the right answer.
"""

from bench.evaluation.challenge.hidden_plant import MECHANISMS
from compensator.lab.effects.catalogue import catalogue

ACCEPTED: dict[str, tuple[str, ...]] = {
    "viscous_asymmetry": ("viscous_asymmetry",),
    "coulomb_asymmetry": ("coulomb_asymmetry",),
    "drag": ("viscous_quadratic",),
    "periodic_friction": ("position_periodic_friction",),
    "run_in": ("warm_up",),
    "spring": ("spring",),
    "centre_of_mass": ("centre_of_mass_angle",),
    "lubricant": ("viscous_temperature",),
    "cogging": ("cogging",),
    "dead_time": ("dead_time",),
    "thermal_drift": ("winding_temperature", "motor_warm_up"),
    "eccentricity": ("encoder_eccentricity",),
    "load_friction": ("load_friction",),
    "weight_growth": ("weight_friction", "weight_stribeck"),
    "bristle": ("pre_sliding", "frictional_lag"),
    "dwell": ("dwell_strengthening",),
    "backlash": ("backlash",),
    "shaft": ("elasticity",),
    "latency": ("measurement_delay",),
    "clutch": (),
    "hose": (),
    "friction_jump": (),
    "supply_ripple": (),
}
"""Mechanism -> names that are right."""

ABSORBED: dict[str, str] = {"coulomb_asymmetry": "offset", "latency": "measurement_delay"}
"""Mechanism -> effect of every model that does the same while the joint moves: no recording of motion can tell."""

RECORDED: dict[str, str] = {"measurement_delay": "a sample is taken at the end of the cycle whose effort it holds"}
"""Effect -> why it is in every recording, whatever is hidden: to name it is neither right nor wrong."""


def accepted(mechanism: str) -> tuple[str, ...]:
    """Names in the catalogue that are right for a mechanism; none where it is outside the catalogue."""
    known = catalogue()
    return tuple(name for name in ACCEPTED[mechanism] if name in known)


def title_of(mechanism: str) -> str:
    """A mechanism in words."""
    return MECHANISMS[mechanism].title
