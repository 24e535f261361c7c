"""How well starts from rest tell two effects apart, and would if ramps were added: predicted d'.

As `separation` on rows in motion, on the small regression of breakaway: rows are starts, weighted by how well their
effort is known and by how much starts scatter; what stands in for a rival is the column of seeing the motion late.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.at_rest.breakaway_regression import LAG, BreakawayFit, back_column, fit_breakaway, lag_column
from compensator.lab.at_rest.breakaway_rows import BreakawayRows, breakaway_rows, shares_of
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import BreakawayShare, Effect, Shape
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.next_trial.rivalry import Equations, Rival, Rivalry
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Base


class BreakawaySeparation(Rivalry):
    """Predicted d' between rivals of breakaway, on the starts of a diagnosis and on those of trials to come.

    Args:
        fit: the diagnosed model.
        candidates: the rivals, as the diagnosis found them.

    Raises:
        UnusableDataError: the trials have no start from rest.
    """

    def __init__(self, fit: Fit, candidates: Sequence[Candidate]) -> None:
        rows = breakaway_rows(fit)
        if rows is None:
            raise UnusableDataError("these trials have no start from rest; record breakaway ramps")
        self._fit, self._starts = fit, fit_breakaway(rows, fit.effects)
        inside, weight = rows.training, self._starts.weight[rows.training]
        self._typical_sd = float(np.median(self._deviation(rows)))
        self.rivals = [_rival(self._starts, candidate) for candidate in candidates]
        self.suspects = len(self.rivals)
        self._nuisance, self._model = (LAG,), self._starts.columns.shape[1] - 1
        base = Base.of(weight[:, None] * self._starts.columns[inside], weight * rows.free[inside])
        left = base.extended(weight[:, None] * _columns(rows, self.rivals[0], self.rivals[0].shape)[inside]).residual
        self.noise_power = float(np.mean(left**2))
        self._inflation = [1.0] * len(self.rivals)  # units are two starts: what they share is in their scatter
        self.measured = self._equations(rows, inside, weight)
        self._stretches = int(inside.sum())
        shares = [_share(one.effect) for one in self.rivals]
        bounds = [[(known.low, known.high) for known in share.parameters] for share in shares]
        self.rivals = self._sized(candidates, bounds)

    @property
    def dataset(self) -> Dataset:
        """Of the diagnosed model."""
        return self._fit.dataset

    def of_trials(self, dataset: Dataset) -> Equations:
        """Normal equations that the starts of trials to come would add; none where they have no start."""
        every = np.ones(len(dataset.trial_index), dtype=bool)
        planned = replace(self._fit, dataset=dataset, training=every)
        rows = breakaway_rows(replace(planned, dataset=with_own_prediction(dataset, planned.terms)))
        if rows is None:
            return Equations(0, np.zeros_like(self.measured.gram))
        weight = self._typical_sd / np.maximum(self._deviation(rows), np.finfo(float).tiny)
        return self._equations(rows, np.ones(len(rows), dtype=bool), weight)

    def _equations(self, rows: BreakawayRows, chosen: BoolArray, weight: FloatArray) -> Equations:
        known = self._starts.shares
        model = [
            rows.columns(_share(effect), next(one.shape for one in known if one.name == effect.name))
            for effect, _ in shares_of(self._fit.effects)
        ]
        shaped = [_columns(rows, one, shape) for one in self.rivals for shape in one.shapes]
        stacked = (
            np.nan_to_num(np.concatenate([*model, back_column(rows), lag_column(rows), *shaped], axis=1))[chosen]
            * weight[:, None]
        )
        return Equations(len(stacked), stacked.T @ stacked)

    def _deviation(self, rows: BreakawayRows) -> FloatArray:
        """Standard deviation of each start's effort about the model, shape (E,)."""
        trials = rows.fit.dataset.trials
        period_s = np.array([1.0 / trials[index].signals.rate_hz for index in rows.trial_index])
        known: FloatArray = np.sqrt(
            rows.effort_sd**2 + (rows.rate * period_s) ** 2 / 12.0 + self._starts.scatter**2
        )  # uniform within a sample, as in the fit
        return known

    @staticmethod
    def _stands_in(rival: Rival) -> frozenset[str]:
        return frozenset({LAG}) if _share(rival.effect).replaces_lag else frozenset()


def _rival(starts: BreakawayFit, candidate: Candidate) -> Rival:
    """The rival as fitted freely beside the model, at its best shape."""
    rows, effect = starts.rows, effect_named(candidate.effect.name)
    share = _share(effect)
    shapes = tuple(rows.shapes(share))
    own = np.nan_to_num(rows.columns(share, candidate.shape))
    model = starts.columns[:, :-1] if share.replaces_lag else starts.columns
    inside, weight = rows.training, starts.weight[rows.training]
    columns = weight[:, None] * np.column_stack([own, model])[inside]
    found = np.linalg.lstsq(columns, weight * rows.free[inside], rcond=1e-9)[0].astype(np.float64)
    whole = shapes if candidate.shape in shapes else (*shapes, candidate.shape)
    return Rival(effect, candidate.shape, found[: own.shape[1]], whole)


def _columns(rows: BreakawayRows, rival: Rival, shape: Shape) -> FloatArray:
    return rows.columns(_share(rival.effect), shape)


def _share(effect: Effect) -> BreakawayShare:
    assert effect.breakaway is not None  # rivals of breakaway, and the model's own shares, have one
    return effect.breakaway
