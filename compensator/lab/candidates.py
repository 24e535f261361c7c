"""Every effect and driver spline that could be missing from a fitted model, as blocks to be screened."""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab import catalogue
from compensator.lab.effects.effect import Effect, EffectRows, Shape
from compensator.lab.errors import NotApplicableError
from compensator.lab.evidence import Base, Block
from compensator.lab.fit import Fit
from compensator.lab.generic import DriverBlock, driver_blocks
from compensator.lab.nuisance import nuisance_columns
from compensator.lab.prediction import with_own_prediction
from compensator.lab.recording import FloatArray
from compensator.lab.regimes import BoolArray
from compensator.lab.weights import row_weights

TANGENT_STEP = 0.05  # relative change of a shape value for its tangent column


@dataclass(frozen=True)
class Candidates:
    """What a fitted model may be missing, over the rows that are tested.

    Attributes:
        fit: the model, its own prediction in every motion.
        show_in: which rows are tested.
        rows: tested, shape (N,).
        weights: of those rows, shape (n,).
        bases: what blocks are judged on top of.
        named: blocks of catalogue effects, all shapes.
        splines: driver splines by block name.
        generic: blocks of the driver splines.
        left_out: effect name -> why it cannot be judged on these trials.
    """

    fit: Fit
    show_in: EffectRows
    rows: BoolArray
    weights: FloatArray
    bases: list[Base]
    named: list[Block]
    splines: dict[str, DriverBlock]
    generic: list[Block]
    left_out: dict[str, str]

    def with_block(self, block: Block) -> "Candidates":
        """The same candidates judged on top of one more block."""
        return replace(self, bases=[base.extended(block.columns) for base in self.bases])


def gather(fit: Fit, show_in: EffectRows = "sliding") -> Candidates:
    """Collect candidates for a fitted model: training rows, weighted, on top of model and nuisance columns.

    Args:
        fit: of the model.
        show_in: the rows that are tested, and the effects that show in them.
    """
    dataset = with_own_prediction(fit)
    fit = replace(fit, dataset=dataset)
    rows = fit.training & dataset.in_regimes(show_in)
    weights = row_weights(dataset, fit.residual, rows)
    builder = _Builder(fit, show_in, rows, weights)
    named, left_out = builder.named()
    splines = {f"{b.driver}{' against motion' if b.against_motion else ''}": b for b in driver_blocks(dataset)}
    generic = [Block(name, builder.weighted(b.columns), 0, 1) for name, b in splines.items()]
    return Candidates(fit, show_in, rows, weights, builder.bases, named, splines, generic, left_out)


class _Builder:
    def __init__(self, fit: Fit, show_in: EffectRows, rows: BoolArray, weights: FloatArray) -> None:
        self._fit, self._show_in, self._rows, self._weights = fit, show_in, rows, weights
        self._nuisance = nuisance_columns(fit.dataset, show_in)
        self._model = model_columns(fit)
        self._index: dict[frozenset[str], int] = {}
        self.bases: list[Base] = []
        self._base_without(frozenset())

    def weighted(self, columns: FloatArray) -> FloatArray:
        return columns[self._rows] * self._weights[:, None]

    def named(self) -> tuple[list[Block], dict[str, str]]:
        blocks, left_out = [], {}
        for effect in catalogue.candidates(self._fit.names, self._fit.dataset.facts):
            if effect.rows != self._show_in:
                continue
            hiding = [name for name in effect.hidden_by if name in self._fit.names]
            if hiding:
                left_out[effect.name] = _hidden(effect, hiding)
                continue
            try:
                blocks += self._blocks(effect)
            except NotApplicableError as reason:
                left_out[effect.name] = str(reason)
        return blocks, left_out

    def _blocks(self, effect: Effect) -> list[Block]:
        dataset = self._fit.dataset
        shapes: list[Shape] = effect.shapes(dataset.trials[0].motion)
        base = self._base_without(effect.standing_in)
        return [
            Block(effect.name, self.weighted(columns), base, len(shapes), shape)
            for shape, columns in zip(shapes, dataset.columns_of_shapes(effect, shapes), strict=True)
        ]

    def _base_without(self, nuisances: frozenset[str]) -> int:
        if nuisances not in self._index:
            kept = [column for name, column in self._nuisance.items() if name not in nuisances]
            columns = np.column_stack([self._model, *kept])
            self._index[nuisances] = len(self.bases)
            effort = self._weights * self._fit.dataset.effort[self._rows]
            self.bases.append(Base.of(self.weighted(columns), effort))
        return self._index[nuisances]


def _hidden(effect: Effect, hiding: list[str]) -> str:
    return (
        f"{effect.name} hides in the free scale of {' and '.join(hiding)}: nothing can tell it from "
        f"{' or '.join(effect.confused_with)}; {effect.excited_by} would"
    )


def model_columns(fit: Fit) -> FloatArray:
    """The model's columns that no bound holds, and the tangent of every fitted shape; shape (N, k)."""
    free = np.concatenate([term.kept & ~term.at_bound for term in fit.terms])
    tangents = []
    for term in fit.terms:
        if not term.effect.smooth_shape or term.at_bound.any():
            continue
        for index in range(len(term.shape)):
            moved = tuple(x * (1.0 + TANGENT_STEP * (i == index)) for i, x in enumerate(term.shape))
            here, there = fit.dataset.unchecked_columns(term.effect, [term.shape, moved])
            tangents.append((there - here) @ term.coefficients)
    return np.column_stack([fit.columns[:, free], *tangents])
