"""How a model's prediction changes with the shapes of its effects: to first order, as one more column each."""

import numpy as np

from compensator.lab.effects.effect import Shape
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Term
from compensator.lab.recordings.recording import FloatArray

TANGENT_STEP = 0.05  # relative change of a shape value


def tangents(fit: Fit) -> FloatArray:
    """What each fitted shape value changes when it grows by TANGENT_STEP, over all rows, shape (N, shape values)."""
    found = [np.empty((len(fit.dataset.effort), 0))]
    for term in fit.terms:
        for moved in moved_shapes(term):
            here, there = fit.dataset.unchecked_columns(term.effect, [term.shape, moved])
            found.append(((there - here) @ term.coefficients)[:, None])
    return np.concatenate(found, axis=1)


def moved_shapes(term: Term) -> list[Shape]:
    """The term's shape with one value after the other moved a little; none where it is held."""
    if not term.effect.smooth_shape or term.at_bound.any():
        return []
    return [
        tuple(x * (1.0 + TANGENT_STEP * (i == index)) for i, x in enumerate(term.shape))
        for index in range(len(term.shape))
    ]
