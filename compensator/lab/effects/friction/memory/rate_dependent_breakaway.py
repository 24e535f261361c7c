"""Static friction that falls with the rate at which the effort rises."""

import numpy as np

from compensator.lab.effects.effect import BreakawayShare, Effect, Motion, Onset, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Nothing in motion."""
    return np.zeros((1, len(motion.time_s)))


def onset_shapes(onset: Onset) -> list[Shape]:
    """Rates from the slowest to the quickest."""
    return [(float(rate),) for rate in np.geomspace(float(onset.rate.min()), float(onset.rate.max()), 3)]


def at_breakaway(onset: Onset, shape: Shape) -> FloatArray:
    """The share of its fall that static friction has made at this rate, for shape (r_0,)."""
    return (-onset.motion.direction * onset.rate / (onset.rate + shape[0]))[None]


BREAKAWAY = BreakawayShare(
    columns=at_breakaway,
    parameters=(Parameter("fall of static friction", "{effort}", 0.0),),
    driver="effort_rate",
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
        "grow together. What a start gains before its motion is seen goes the other way, so only a net fall is named."
    ),
    equation=r"-c\,\frac{r}{r + r_0}\,\mathrm{sgn}(\dot q)\;[\text{at breakaway}],\quad r = |d\tau/dt|",
    columns=columns,
    parameters=(Parameter("fall of static friction", "{effort}", 0.0),),
    driver="effort_rate",
    excited_by="breakaway ramps at rates that differ ten times and more, after equal rests",
    source="Johannes, Green, Brockley 1973; Richardson, Nolle 1976; Armstrong, Dupont, Canudas de Wit 1994",
    confused_with=("dwell_strengthening", "pre_sliding"),
    rows="breakaway",
    breakaway=BREAKAWAY,
)
