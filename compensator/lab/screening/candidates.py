"""Every effect and driver spline that could be missing from a fitted model, as blocks to be screened."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from compensator.lab.effects import catalogue
from compensator.lab.effects.effect import Effect, MotionRows, Shape
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fitted import STATIC, Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.model.weights import bounded_influence, row_weights
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.discrepancy import model_columns
from compensator.lab.screening.generic import HYSTERESIS_DRIVER, DriverBlock, driver_blocks, hysteresis_columns
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.nuisance import nuisance_columns
from compensator.lab.screening.stops import StopToStop

WITH_CHAIN = 0  # base with all columns that the measuring chain can produce; others lack what an effect stands in for


class Curves:
    """Driver splines, made when they are first asked for: effects with memory are judged without them.

    Args:
        dataset: of the rows.
        weighted: picks and weights the tested rows of columns (N, k).
    """

    def __init__(self, dataset: Dataset, weighted: Callable[[FloatArray], FloatArray]) -> None:
        self._dataset, self._weighted = dataset, weighted

    def evened(self, noise: Noise) -> "Curves":
        """The same, their blocks evened."""
        return Curves(self._dataset, lambda columns: noise.evened(self._weighted(columns)))

    @cached_property
    def splines(self) -> dict[str, DriverBlock]:
        """By block name."""
        found = driver_blocks(self._dataset)
        return {f"{one.driver}{' against motion' if one.against_motion else ''}": one for one in found}

    @cached_property
    def blocks(self) -> list[Block]:
        """The splines as blocks to be screened."""
        return [Block(name, self._weighted(spline.columns), 0, 1) for name, spline in self.splines.items()]

    @cached_property
    def hysteresis_columns(self) -> FloatArray:
        """Of a free hysteresis of position, over all rows, shape (N, k)."""
        return hysteresis_columns(self._dataset)

    @cached_property
    def hysteresis(self) -> Block:
        """The same as a block to be screened."""
        return Block(HYSTERESIS_DRIVER, self._weighted(self.hysteresis_columns), 0, 1)


@dataclass(frozen=True)
class Candidates:
    """What a fitted model may be missing, over the rows that are tested.

    Attributes:
        fit: the model, its own prediction in every motion.
        show_in: which rows are tested.
        rows: tested, shape (N,).
        weights: of those rows, shape (n,).
        bases: what blocks are judged on top of; evened, as all blocks are, where the noise is known.
        named: blocks of catalogue effects, all shapes.
        curves: of every driver, free.
        left_out: effect name -> why it cannot be judged on these trials.
        noise: that a complete model would leave on these rows; None where it was not learnt (see `clearing`).
    """

    fit: Fit
    show_in: MotionRows
    rows: BoolArray
    weights: FloatArray
    bases: list[Base]
    named: list[Block]
    curves: "Curves"
    left_out: dict[str, str]
    noise: Noise | None = None

    def with_block(self, block: Block) -> "Candidates":
        """The same candidates judged on top of one more block."""
        return replace(self, bases=[base.extended(block.columns) for base in self.bases])

    def with_columns(self, columns: FloatArray) -> "Candidates":
        """The same candidates judged on top of more columns, given over all rows, shape (N, k)."""
        tested = self.tested(columns)
        return replace(self, bases=[base.extended(tested) for base in self.bases])

    def tested(self, columns: FloatArray) -> FloatArray:
        """Columns (N, k) given over all rows as blocks have them: the tested rows, weighted and evened, (n, k)."""
        weighted = columns[self.rows] * self.weights[:, None]
        return weighted if self.noise is None else self.noise.evened(weighted)

    def evened(self, noise: Noise) -> "Candidates":
        """The same candidates, judged against a noise: rows count by what it leaves sure."""
        return replace(
            self,
            bases=[
                Base.of(noise.evened(base.basis), noise.evened(base.residual[:, None])[:, 0]) for base in self.bases
            ],
            named=[replace(block, columns=noise.evened(block.columns)) for block in self.named],
            curves=self.curves.evened(noise),
            noise=noise,
        )

    def as_measured(self, index: int) -> Base:
        """One of the bases on weighted rows, every one as it was measured."""
        base = self.bases[index]
        if self.noise is None:
            return base
        return Base.of(self.noise.as_measured(base.basis), self.noise.as_measured(base.residual[:, None])[:, 0])


def gather(fit: Fit, show_in: MotionRows = "sliding") -> Candidates:
    """Collect candidates for a fitted model: training rows, weighted, on top of model and nuisance columns.

    Args:
        fit: of the model.
        show_in: the rows that are tested, and the effects that show in them.
    """
    ground, builder = _ground(fit, show_in)
    named, left_out = builder.named()
    return replace(ground, bases=builder.bases, named=named, left_out=left_out)


def gather_curves(fit: Fit, show_in: MotionRows = "sliding") -> Candidates:
    """The same without the effects of the catalogue: what the model leaves, and free curves. Arguments as `gather`."""
    return _ground(fit, show_in)[0]


def _ground(fit: Fit, show_in: MotionRows) -> "tuple[Candidates, _Builder]":
    dataset = with_own_prediction(fit.dataset, fit.terms)
    fit = replace(fit, dataset=dataset)
    rows = fit.training & dataset.in_regimes(show_in)
    weights = row_weights(dataset, fit.residual, rows) * dataset.steadiness[rows]
    weights = weights * bounded_influence(fit.residual[rows], weights)
    builder = _Builder(fit, show_in, rows, weights)
    return Candidates(fit, show_in, rows, weights, builder.bases, [], Curves(dataset, builder.weighted), {}), builder


class _Builder:
    def __init__(self, fit: Fit, show_in: MotionRows, rows: BoolArray, weights: FloatArray) -> None:
        self._fit, self._show_in, self._rows, self._weights = fit, show_in, rows, weights
        self._nuisance = nuisance_columns(fit.dataset, show_in)
        self._model = model_columns(fit)
        self._index: dict[frozenset[str], int] = {}
        self.bases: list[Base] = []
        self._base_without(frozenset())

    def weighted(self, columns: FloatArray) -> FloatArray:
        return columns[self._rows] * self._weights[:, None]

    def named(self) -> tuple[list[Block], dict[str, str]]:
        """Blocks of all effects that can be judged, and why the others cannot."""
        dataset = self._fit.dataset
        wanted, left_out = self._judged()
        made = dataset.columns_of_effects([(effect, shapes) for effect, shapes in wanted])
        blocks = [
            Block(effect.name, self.weighted(columns), self._base_without(effect.standing_in), len(shapes), shape)
            for (effect, shapes), found in zip(wanted, made, strict=True)
            for shape, columns in zip(shapes, found, strict=True)
        ]
        return blocks, left_out

    def _judged(self) -> tuple[list[tuple[Effect, list[Shape]]], dict[str, str]]:
        dataset = self._fit.dataset
        wanted, left_out = [], {}
        for effect in catalogue.candidates(self._fit.names, dataset.facts):
            if effect.rows != self._show_in:
                continue
            hiding = [name for name in effect.hidden_by if name in self._fit.names]
            if hiding:
                left_out[effect.name] = _hidden(effect, hiding)
                continue
            try:
                dataset.check_applicable(effect)
            except NotApplicableError as reason:
                left_out[effect.name] = str(reason)
                continue
            wanted.append((effect, effect.shapes(dataset.trials[0].motion)))
        return wanted, left_out

    def _base_without(self, nuisances: frozenset[str]) -> int:
        if nuisances not in self._index:
            kept = [column for name, column in self._nuisance.items() if name not in nuisances]
            columns = np.column_stack([self._model, *kept])
            self._index[nuisances] = len(self.bases)
            effort = self._weights * self._fit.target[self._rows]
            self.bases.append(Base.of(self.weighted(columns), effort))
        return self._index[nuisances]


def _hidden(effect: Effect, hiding: list[str]) -> str:
    return (
        f"{effect.name} hides in the free scale of {' and '.join(hiding)}: nothing can tell it from "
        f"{' or '.join(effect.confused_with)}; {effect.excited_by} would"
    )


def noise_of(gathered: Candidates, left: Candidates) -> Noise:
    """The noise of the candidates' rows, from what is left of them once more is in the model."""
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    base = left.bases[0]
    return Noise.learnt(gathered.fit.dataset, gathered.rows, (base.basis, base.residual), before, _strokes_of(gathered))


def _strokes_of(gathered: Candidates) -> StopToStop | None:
    """Static friction from stop to stop in the tested rows; None where the model has none."""
    fit, rows = gathered.fit, gathered.rows
    ends = np.cumsum([len(term.coefficients) for term in fit.terms])
    place = next((int(end) - 1 for end, term in zip(ends, fit.terms, strict=True) if term.effect.name == STATIC), None)
    if place is None or fit.coefficients[place] <= 0.0:
        return None
    stroke = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in fit.dataset.trials])
    _, index = np.unique(np.stack([fit.dataset.trial_index, stroke])[:, rows], axis=1, return_inverse=True)
    share = gathered.weights * fit.columns[rows, place] * fit.coefficients[place]
    return StopToStop(share, np.asarray(index, dtype=np.int64).ravel())
