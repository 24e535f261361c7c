"""Static friction that rises with the time at rest."""

import numpy as np

from compensator.lab.effects.effect import BreakawayShare, Effect, Motion, Onset, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.reversals import REST_S


def shapes(motion: Motion) -> list[Shape]:
    """Distances from a five-hundredth to a fifth of the travel."""
    return [(float(share * motion.position_span),) for share in np.geomspace(2e-3, 0.2, 5)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Logarithm of the last rest, forgotten over a distance, for shape (x_d,)."""
    dwell_s, travel = motion.last_rest
    return (np.log1p(dwell_s / REST_S) * np.exp(-travel / shape[0]) * motion.direction)[None]


def onset_shapes(onset: Onset) -> list[Shape]:
    """Times from below the shortest to the longest rest."""
    shortest, longest = float(onset.rest_s.min()), float(onset.rest_s.max())
    return [(float(time_s),) for time_s in np.geomspace(0.3 * shortest, longest, 5)]


def at_breakaway(onset: Onset, shape: Shape) -> FloatArray:
    """The share of its rise that static friction has made in the rest, for shape (t_0,)."""
    return (onset.motion.direction * onset.rest_s / (onset.rest_s + shape[0]))[None]


BREAKAWAY = BreakawayShare(
    columns=at_breakaway,
    parameters=(Parameter("rise of static friction", "{effort}", 0.0),),
    driver="rest",
    shapes=onset_shapes,
    shape_names=("rest that makes half the rise",),
    shape_units=("s",),
)

EFFECT = Effect(
    name="dwell_strengthening",
    title="Rising static friction",
    physics=(
        "The longer surfaces rest on each other, the harder they are to part: static friction grows with the "
        "logarithm of the time at rest, and is gone after a short travel. At breakaway it has risen by "
        "t / (t + t0) of a rise that is reached at last."
    ),
    equation=r"c\,\ln(1 + t_{rest}/t_0)\,e^{-x/x_d}\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(Parameter("rise per factor e of the rest", "{effort}", 0.0),),
    driver="rest",
    excited_by="breakaway ramps after rests of very different lengths: 0.1, 1 and 10 s",
    source="Armstrong, Dupont, Canudas de Wit 1994; Rabinowicz 1958",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("distance that forgets the rest",),
    shape_units=("{position}",),
    confused_with=("stribeck", "pre_sliding"),
    rows="moving",
    breakaway=BREAKAWAY,
)
