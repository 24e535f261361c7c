"""What a fitted model takes of the effort near a motion: between the directions, by direction, and how it changes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.closed_loop.stepping import Resistance
from compensator.lab.effects.effect import Motion
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Term
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset

STEP_SHARE = 1e-4  # of the span of position, over which derivatives are taken


def resistances(fit: Fit, motions: Dataset) -> list[Resistance]:
    """The model near every trial's motion. Effects of the measuring chain are no resistance.

    Args:
        fit: of the model; its coefficients count, not its rows.
        motions: trials whose motion is that around which the model is taken.
    """
    terms = tuple(term for term in fit.terms if not term.effect.pipeline)
    predicted = with_own_prediction(motions, terms)
    return [_around(terms, trial.motion) for trial in predicted.trials]


def _around(terms: Sequence[Term], motion: Motion) -> Resistance:
    same = np.ones(len(motion.position))
    forward, backward = (_sum(terms, replace(motion, direction=way * same)) for way in (1.0, -1.0))
    # what remembers where the joint has been has no derivative at a moment
    local = [term for term in terms if term.effect.rows == "sliding"]
    by_position = STEP_SHARE * motion.position_span
    inertia = motion.inertia
    return Resistance(
        inertia=inertia,
        position=motion.position,
        velocity=motion.velocity,
        middle=0.5 * (forward + backward) - inertia * motion.acceleration,
        per_position=_slope(local, motion, "position", by_position),
        per_velocity=_slope(local, motion, "velocity", motion.slow),
        dry=np.maximum(0.5 * (forward - backward), 0.0),
    )


def _slope(terms: Sequence[Term], motion: Motion, name: str, by: float) -> FloatArray:
    """Derivative of what does not change sign with the direction, shape (n,)."""
    still = replace(motion, direction=np.zeros(len(motion.position)))
    ahead, behind = (_sum(terms, replace(still, **{name: getattr(motion, name) + way * by})) for way in (1.0, -1.0))
    slope: FloatArray = (ahead - behind) / (2.0 * by)
    return slope


def _sum(terms: Sequence[Term], motion: Motion) -> FloatArray:
    total = np.zeros(len(motion.position))
    for term in terms:
        total += term.coefficients @ term.effect.columns(motion, term.shape)
    return total
