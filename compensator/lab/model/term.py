"""One effect of a fitted model, with what the fit made of it."""

from dataclasses import dataclass

from compensator.lab.effects.effect import Effect, Shape
from compensator.lab.recordings.recording import BoolArray, FloatArray


@dataclass(frozen=True)
class Term:
    """One fitted effect.

    Attributes:
        effect: which.
        shape: its nonlinear shape values.
        coefficients: one per parameter of the effect, shape (k,).
        kept: which of them the data determine.
        at_bound: which of them a physical bound holds.
    """

    effect: Effect
    shape: Shape
    coefficients: FloatArray
    kept: BoolArray
    at_bound: BoolArray
