"""A fitted model: its terms, what it predicts, what it leaves, and how well it knows that."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from compensator.lab.effects.effect import Effect, Shape
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.linear import Bounds, Term
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset, RowChoice

STATIC = "stribeck"
EFFORT_UNIT = "{effort}"
DRY = ("coulomb", "stribeck")  # effects whose sum is dry friction, and static friction at rest


@dataclass(frozen=True)
class Fit:
    """A model fitted to counted training rows.

    Attributes:
        dataset: with the model's own prediction in its motions.
        training: rows used, shape (N,).
        terms: the fitted effects, in the model's order.
        columns: of all terms, shape (N, K).
        weight: of each row in the fit, shape (N,).
        target: what the columns were fitted to, shape (N,): the effort, or that of the model's tangent where it bends.
        judged: what `held_out` has found of it, by the rows that it was asked for; a search asks again and again.
    """

    dataset: Dataset
    training: BoolArray
    terms: tuple[Term, ...]
    columns: FloatArray
    weight: FloatArray
    target: FloatArray
    judged: dict[RowChoice, HeldOut] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def coefficients(self) -> FloatArray:
        """Of all terms, shape (K,)."""
        return np.concatenate([term.coefficients for term in self.terms])

    @property
    def bounds(self) -> Bounds:
        """Physical bounds of all coefficients."""
        return bounds_of(self.effects, self.dataset)

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects themselves."""
        return tuple(term.effect for term in self.terms)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects."""
        return tuple(term.effect.name for term in self.terms)

    @property
    def shapes(self) -> dict[str, Shape]:
        """Shape of each effect by name."""
        return {term.effect.name: term.shape for term in self.terms}

    @property
    def dry_friction(self) -> float:
        """What the model takes off the effort, or adds to it, at the slowest, by the direction of motion alone."""
        return sum(float(term.coefficients[0]) for term in self.terms if term.effect.name in DRY)

    @property
    def static_friction(self) -> FloatArray:
        """What static friction adds to the effort beyond that of sliding, until it has fallen off; shape (N,)."""
        found = np.zeros(len(self.dataset.effort))
        for term in self.terms:
            if term.effect.name == STATIC:
                found += self.dataset.columns(term.effect, term.shape) @ term.coefficients
        return found

    @property
    def training_equations(self) -> tuple[FloatArray, FloatArray]:
        """Weighted columns (n, K) and target (n,) of the training rows."""
        weight = self.weight[self.training]
        return weight[:, None] * self.columns[self.training], weight * self.target[self.training]

    @property
    def predicted(self) -> FloatArray:
        """Predicted effort of every row, shape (N,)."""
        return self.dataset.effort - self.residual

    @cached_property
    def residual(self) -> FloatArray:
        """Measured minus predicted effort of every row, shape (N,)."""
        return self.target - self.columns @ self.coefficients


def with_terms(fit: Fit, coefficients: FloatArray) -> Fit:
    """The fit whose terms have other coefficients (K,), and nothing else: what its motions predict is still the old."""
    ends = np.cumsum([len(term.coefficients) for term in fit.terms])[:-1]
    parts = np.split(coefficients, ends)
    terms = tuple(replace(term, coefficients=part) for term, part in zip(fit.terms, parts, strict=True))
    return replace(fit, terms=terms)


def bounds_of(effects: Sequence[Effect], dataset: Dataset) -> Bounds:
    """Physical bounds of all parameters of the effects, in order, in the effort of a dataset.

    No friction was larger than the largest effort, which overcame it: where hardly a row shows static friction,
    rounding would make it any number.
    """
    quantity = dataset.effort_definition.quantity
    largest = float(np.abs(dataset.effort).max(initial=0.0))
    ranges = [
        (low, min(high, largest) if effect.dry_friction and parameter.unit == EFFORT_UNIT else high)
        for effect in effects
        for parameter, (low, high) in zip(effect.parameters, effect.ranges_in(quantity), strict=True)
    ]
    low, high = np.array(ranges).reshape(-1, 2).T
    return Bounds(low, high)


def trained_trials(dataset: Dataset, training: BoolArray) -> IntArray:
    """Which trials a model may be fitted to: those of its training rows, and those that nobody held out.

    A trial of reversals or starts alone has no sliding row, and so no training row of a model of sliding; it is not
    held out by that. Where trials are left out that the owner does not hold out, nobody knows, and it stays out.

    Args:
        dataset: of the rows.
        training: rows of the study's choice that the model is fitted to, shape (N,).
    """
    trained = np.unique(dataset.trial_index[training])
    counted = np.unique(dataset.trial_index[dataset.counted])
    every = np.setdiff1d(np.arange(len(dataset.trials), dtype=np.int64), list(dataset.held_out))
    return every if np.isin(np.intersect1d(counted, every), trained).all() else trained
