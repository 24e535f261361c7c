"""Frictional lag."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Speeds from the uncertain ones to half the fast ones."""
    speeds = np.geomspace(2.0 * motion.slow, max(0.5 * motion.fast, 4.0 * motion.slow), 4)
    return [(float(speed),) for speed in speeds]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Rate of change of speed, where friction falls with speed, for shape (v_s,); to first order in the lag."""
    speed = np.abs(motion.velocity)
    return (motion.acceleration * motion.direction**2 * np.exp(-speed / shape[0]))[None]


EFFECT = Effect(
    name="frictional_lag",
    title="Frictional lag",
    physics=(
        "Friction follows a change of speed late, as the film between the surfaces thickens and thins: it is "
        "larger while the speed rises than while it falls."
    ),
    equation=r"c\,\mathrm{sgn}(\dot q)\,\frac{d|\dot q|}{dt}\,e^{-|\dot q|/v_s}",
    columns=columns,
    parameters=(Parameter("lag times slope of the Stribeck curve", "{effort} s2/{position}", 0.0),),
    driver="acceleration",
    excited_by="slow motion whose speed rises and falls at several frequencies without reversing",
    source="Hess, Soom 1990; Armstrong, Dupont, Canudas de Wit 1994",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("speed over which friction falls",),
    shape_units=("{position}/s",),
    confused_with=("inertia", "pre_sliding"),
    standing_in=frozenset({"slow_sign", "fast_sign", "sign_rate"}),
    rows="moving",
)
