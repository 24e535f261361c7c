"""Stribeck effect."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

EXPONENTS = tuple(np.geomspace(1.0, 2.0, 4).tolist())


def shapes(motion: Motion) -> list[Shape]:
    """Stribeck speeds from just above the uncertain ones to half the fast ones, each with exponents from 1 to 2.

    Between two exponents alone a search can end in a valley of its own, far from the best speed.
    """
    speeds = np.geomspace(2.0 * motion.slow, max(0.5 * motion.fast, 4.0 * motion.slow), 7)
    return [(float(speed), exponent) for exponent in EXPONENTS for speed in speeds]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Excess of static over Coulomb friction at this speed, for shape (v_s, delta)."""
    speed, exponent = shape
    power = np.exp(exponent * (motion.log_speed - np.log(speed)))
    found: FloatArray = (motion.direction * np.exp(-power))[None]
    return found


EFFECT = Effect(
    name="stribeck",
    title="Stribeck effect",
    physics=(
        "Friction falls from its static to its Coulomb value as speed builds up a lubricant film: the General "
        "Kinetic Friction model of the paper."
    ),
    equation=r"(F_s - F_c)\,e^{-|\dot q/v_s|^{\delta}}\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(Parameter("static minus Coulomb friction", "{effort}", 0.0),),
    driver="velocity",
    excited_by="slow motion: many rows below and around the Stribeck speed",
    source="Saini et al. 2013, eq. (2)",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("Stribeck speed", "Stribeck exponent"),
    shape_units=("{position}/s", "1"),
    confused_with=("viscous_quadratic",),
    dry_friction=True,
)
