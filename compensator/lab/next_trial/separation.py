"""Rivals on the rows of a diagnosis in which they show, and on those of trials to come: predicted d' between them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.model.weights import RowWeights
from compensator.lab.next_trial.rivalry import Equations, Rival, Rivalry, rows_per_independent_row
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.discrepancy import model_columns
from compensator.lab.screening.evidence import inflation_of
from compensator.lab.screening.nuisance import nuisance_columns


class Separation(Rivalry):
    """Predicted d' between rivals, on the rows of a diagnosis and on those of trials to come.

    Args:
        gathered: what the diagnosed model may be missing, on the rows where the rivals show.
        candidates: the rivals, as the diagnosis found them.
        others: effects that may imitate one of these, but are not taken for the truth.
    """

    def __init__(self, gathered: Candidates, candidates: Sequence[Candidate], others: Sequence[str] = ()) -> None:
        self._fit, self._show_in = gathered.fit, gathered.show_in
        self._weights = RowWeights.learnt(gathered.fit.dataset, gathered.fit.residual, gathered.rows)
        self.rivals = [_rival(gathered, candidate) for candidate in candidates]
        self.rivals += [_imitator(gathered, name) for name in others]
        self.suspects = len(candidates)
        left = _left_by_best(gathered, candidates[0])
        self.noise_power = float(np.mean(left**2))
        stretch = gathered.fit.dataset.block_index[gathered.rows]
        self._stretches = len(np.unique(stretch))
        inflation = inflation_of(left)
        self._inflation = [max(inflation, _between_stretches(gathered, one, left, stretch)) for one in candidates]
        self._nuisance = tuple(nuisance_columns(gathered.fit.dataset, gathered.show_in))
        self._model = model_columns(gathered.fit).shape[1]
        stacked = self._columns(gathered.fit, gathered.weights, gathered.rows)
        self.measured = Equations(len(stacked), stacked.T @ stacked)
        quantity = gathered.fit.dataset.effort_definition.quantity
        self.rivals = self._sized(candidates, [one.effect.ranges_in(quantity) for one in candidates])

    @property
    def dataset(self) -> Dataset:
        """Of the diagnosed model."""
        return self._fit.dataset

    def of_trials(self, dataset: Dataset) -> Equations:
        """Normal equations that trials to come would add, by the model's own prediction."""
        planned = replace(self._fit, dataset=dataset)
        dataset = with_own_prediction(planned.dataset, planned.terms)
        columns = [dataset.unchecked_columns(term.effect, [term.shape])[0] for term in self._fit.terms]
        counted = dataset.in_regimes(self._show_in)
        fit = replace(planned, dataset=dataset, columns=np.concatenate(columns, axis=1))
        weights = self._weights.of(dataset, counted) * dataset.steadiness[counted]
        stacked = self._columns(fit, weights, counted)
        return Equations(len(stacked), stacked.T @ stacked)

    def _columns(self, fit: Fit, weights: FloatArray, rows: BoolArray) -> FloatArray:
        """Weighted columns of the model, of the measuring chain, and of every shape of every rival; shape (n, K)."""
        model = model_columns(fit)
        nuisance = nuisance_columns(fit.dataset, self._show_in)
        blocks = [block for one in self.rivals for block in fit.dataset.unchecked_columns(one.effect, [*one.shapes])]
        stacked: FloatArray = np.column_stack([model, *nuisance.values(), *blocks])[rows] * weights[:, None]
        return stacked

    @staticmethod
    def _stands_in(rival: Rival) -> frozenset[str]:
        return frozenset(rival.effect.standing_in)


def _rival(gathered: Candidates, candidate: Candidate) -> Rival:
    effect = effect_named(candidate.effect.name)
    shapes = tuple(effect.shapes(gathered.fit.dataset.trials[0].motion))
    shape = candidate.shape
    block = _block(gathered, candidate)
    coefficients = gathered.bases[block.base].coefficients(block.columns)
    return Rival(effect, shape, coefficients, shapes if shape in shapes else (*shapes, shape))


def _imitator(gathered: Candidates, name: str) -> Rival:
    """An effect that is fitted to what another one makes, and has no size of its own."""
    effect = effect_named(name)
    shapes = tuple(effect.shapes(gathered.fit.dataset.trials[0].motion))
    width = next(one.columns.shape[1] for one in gathered.named if one.name == name)
    return Rival(effect, shapes[0], np.zeros(width), shapes)


def _between_stretches(gathered: Candidates, candidate: Candidate, left: FloatArray, stretch: IntArray) -> float:
    """Rows per independent row for an effect, by its scatter between stretches."""
    block = _block(gathered, candidate)
    base = gathered.bases[block.base]
    projected = base.beyond(block.columns)
    coefficients = np.linalg.lstsq(projected, base.residual, rcond=1e-6)[0]
    return rows_per_independent_row(projected @ coefficients, left, stretch)


def _block(gathered: Candidates, candidate: Candidate) -> Block:
    """The columns of a candidate at its own shape, which is fitted, and need not be one of those that are scanned."""
    scanned = next(one for one in gathered.named if one.name == candidate.effect.name)
    columns = gathered.fit.dataset.unchecked_columns(candidate.effect, [candidate.shape])[0]
    return replace(scanned, columns=gathered.tested(columns), shape=candidate.shape)


def _left_by_best(gathered: Candidates, candidate: Candidate) -> FloatArray:
    """Weighted residual once the first rival is in the model: what counts as noise."""
    block = _block(gathered, candidate)
    return gathered.bases[block.base].extended(block.columns).residual
