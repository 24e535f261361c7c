"""Static friction that falls with the rate at which the effort rises."""

import numpy as np

from compensator.lab.effects.effect import BreakawayShare, Effect, Motion, Onset, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Stribeck speeds from just above the uncertain ones to half the fast ones."""
    fastest = max(0.5 * motion.fast, 4.0 * motion.slow)
    return [(float(speed),) for speed in np.geomspace(2.0 * motion.slow, fastest, 5)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """The Stribeck share, less after a start that is quicker than usual, more after a slower one, for shape (v_s,)."""
    rate, usual = motion.start_rate, motion.usual_start_rate
    factor = np.nan_to_num((usual - rate) / (usual + rate))
    return np.atleast_2d(factor * np.exp(-np.abs(motion.velocity) / shape[0]) * motion.direction)


def onset_shapes(onset: Onset) -> list[Shape]:
    """Rates from the slowest to the quickest."""
    return [(float(rate),) for rate in np.geomspace(float(onset.rate.min()), float(onset.rate.max()), 3)]


def at_breakaway(onset: Onset, shape: Shape) -> FloatArray:
    """The share of its fall that static friction has made at this rate, for shape (r_0,)."""
    return (-onset.motion.direction * onset.rate / (onset.rate + shape[0]))[None]


BREAKAWAY = BreakawayShare(
    columns=at_breakaway,
    parameters=(Parameter("fall of static friction", "{effort}", 0.0),),
    driver="start_rate",
    shapes=onset_shapes,
    shape_names=("rate that makes half the fall",),
    shape_units=("{effort}/s",),
    replaces_lag=True,
)

EFFECT = Effect(
    name="rate_dependent_breakaway",
    title="Rate-dependent breakaway",
    physics=(
        "The quicker the effort rises, the sooner a joint breaks away: the contacts have less time to creep and to "
        "grow together. As the static level is lower then, so is all of the Stribeck share until the joint stands "
        "again. In the effort of the start itself, what is gained before the motion is seen goes the other way: "
        "only a net fall is named there."
    ),
    equation=(
        r"-c\,\frac{r - \bar r}{r + \bar r}\,e^{-|\dot q|/v_s}\,\mathrm{sgn}(\dot q),\quad r = |d\tau/dt|\;"
        r"\text{when the joint last stood}"
    ),
    columns=columns,
    parameters=(Parameter("fall of static friction", "{effort}", 0.0),),
    driver="start_rate",
    excited_by="breakaway ramps at rates that differ ten times and more, after equal rests",
    source="Johannes, Green, Brockley 1973; Richardson, Nolle 1976; Armstrong, Dupont, Canudas de Wit 1994",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("Stribeck speed",),
    shape_units=("{position}/s",),
    confused_with=("dwell_strengthening", "pre_sliding"),
    breakaway=BREAKAWAY,
)
