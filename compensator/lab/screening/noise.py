"""What a complete model would leave: its covariance, and rows made white by it.

Residuals are coloured, by filters and by what drives them. What friction makes of them lies along the path, and so
lasts the longer the slower the motion: slow, middling and fast rows each have noise of their own colour, of one source
(a filter that changes with the speed: Priestley 1965). Rows that are whitened by the covariance are independent, of
unit variance, so that least squares of them are the most sure estimates (Aitken 1935), and each sum of squares in noise
alone is chi-squared.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import solve_triangular

from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import BLOCK_S, FEWEST_ROWS, Dataset
from compensator.lab.screening.base import Base
from compensator.lab.screening.random_effects import RandomEffect

SPEEDS = 3  # kinds of rows, slow to fast, as many of each
MODEL_ERROR = 0.03  # share of the variance, white: at no frequency is a model right to less
PASSES = 2  # of learning what a fit takes from the noise
LONGEST = 1000  # steps of a place's grid: what is farther apart than BLOCK_S is independent
TINY = 1e-30
ROUNDING = 1e-12  # of a sum of many products, over their largest


@dataclass(frozen=True)
class _Place:
    """Rows of one trial whose noise is of one covariance.

    Attributes:
        rows: among all rows.
        grid: on the trial's even grid, shape (n,).
        speed: kind of each row, 0 .. SPEEDS - 1, shape (n,).
        scale: of each row's noise, by the trial's over that of all trials, shape (n,).
    """

    rows: slice
    grid: IntArray
    speed: IntArray
    scale: FloatArray

    @property
    def lags(self) -> IntArray:
        """Between every two rows, shape (n, n)."""
        found: IntArray = np.abs(np.subtract.outer(self.grid, self.grid))
        return found

    def by_lag(self, products: FloatArray, longest: int) -> FloatArray:
        """Sums of products (n, n) of rows of one kind, by lag; (SPEEDS, longest)."""
        alike = np.equal.outer(self.speed, self.speed) & (self.lags < longest)
        place = (self.speed[:, None] * longest + self.lags)[alike]
        found: FloatArray = np.bincount(place, products[alike], SPEEDS * longest).reshape(SPEEDS, longest).astype(float)
        return found

    def covariance(self, kernels: FloatArray) -> FloatArray:
        """Of the rows, by covariances (SPEEDS, SPEEDS, lags) of each two kinds; shape (n, n)."""
        found: FloatArray = kernels[self.speed[:, None], self.speed, self.lags] * np.outer(self.scale, self.scale)
        found[np.diag_indices_from(found)] += MODEL_ERROR * float(np.mean(np.diag(found))) + TINY
        return found


@dataclass(frozen=True)
class Noise:
    """Noise of each trial's rows, of one source, coloured by the speed.

    Attributes:
        roots: of the covariance of each place (Cholesky, lower), with its rows.
        stretches: independent ones of BLOCK_S, less one: how well the colour is known.
        random: effects in the covariance beside the colour.
    """

    roots: tuple[tuple[slice, FloatArray], ...]
    stretches: float
    random: tuple[RandomEffect, ...] = ()

    @classmethod
    def learnt(cls, dataset: Dataset, rows: BoolArray, left: Base, random: Sequence[RandomEffect] = ()) -> "Noise":
        """From what is left.

        Args:
            dataset: of the rows.
            rows: chosen, shape (N,).
            left: what was fitted to the chosen rows, and the weighted residual.
            random: effects whose variances are learnt beside the colour, as far as that does not hold them already.
        """
        covariances = _coloured(dataset, rows, left)

        def power(directions: FloatArray) -> FloatArray:
            each = [np.sum(directions[rows] * (one @ directions[rows]), axis=0) for rows, one in covariances]
            found: FloatArray = np.sum(each, axis=0)
            return found

        found = []
        for effect in (one.learnt(left, power) for one in random):
            if effect.variance > 0.0:
                found.append(effect)
                covariances = [(rows, one + effect.covariance(rows)) for rows, one in covariances]
        roots = tuple((rows, _root(one)) for rows, one in covariances)
        return cls(roots, max(dataset.stretches(rows) - 1, 1), tuple(found))

    @property
    def freedoms(self) -> FloatArray:
        """How well each source of noise is known, as a variance from so many squares: colour, random effects; (s,)."""
        return np.array([self.stretches, *(effect.freedom for effect in self.random)], dtype=float)

    def shares(self, directions: FloatArray) -> FloatArray:
        """Of the variance in each direction (n, k) of whitened rows, of unit norm, what each source has; (s, k)."""
        random = np.zeros((len(self.random), directions.shape[1]))
        for rows, root in self.roots if self.random else ():
            own = solve_triangular(root, directions[rows], lower=True, trans=1, check_finite=False)
            random += [effect.power(rows, own) for effect in self.random]
        return np.vstack([1.0 - random.sum(axis=0), random])

    def whitened(self, values: FloatArray) -> FloatArray:
        """Weighted rows of columns (n, k), their noise independent and of unit variance."""
        found = np.empty_like(values)
        for rows, root in self.roots:
            found[rows] = solve_triangular(root, values[rows], lower=True, check_finite=False)
        return found

    def as_measured(self, values: FloatArray) -> FloatArray:
        """What `whitened` was given, from what it returned, (n, k)."""
        found = np.empty_like(values)
        for rows, root in self.roots:
            found[rows] = root @ values[rows]
        return found


def _root(covariance: FloatArray) -> FloatArray:
    """Cholesky's of a covariance (n, n): where there is no noise, rounding of a random effect leaves it indefinite."""
    white = ROUNDING * float(np.mean(np.diag(covariance)))
    return np.linalg.cholesky(covariance + white * np.eye(len(covariance))).astype(np.float64)


def _coloured(dataset: Dataset, rows: BoolArray, fitted: Base) -> list[tuple[slice, FloatArray]]:
    """Rows of each place, and their covariance (n, n), by what a fit of the chosen rows (N,) has left."""
    places, longest = _places(dataset, rows, fitted.residual)
    pairs = np.sum([place.by_lag(np.outer(place.scale, place.scale), longest) for place in places], axis=0)
    residual = fitted.residual[:, None]
    left = np.sum([_by_lag(place, residual, residual, longest) for place in places], axis=0)
    free = len(residual) / max(len(residual) - fitted.basis.shape[1], 1)
    kernels = _kernels(free * left / np.maximum(pairs, TINY))
    for _ in range(PASSES):
        taken = _taken(places, fitted.basis, kernels, longest)
        kernels = _kernels((left + taken) / np.maximum(pairs, TINY))
    return [(place.rows, place.covariance(kernels)) for place in places]


def _taken(places: list[_Place], basis: FloatArray, kernels: FloatArray, longest: int) -> FloatArray:
    """What a fit of an orthonormal basis (n, b) takes from noise's products by lag, shape (SPEEDS, longest).

    A residual is e - BB'e, so that of its covariance BA' + AB' is missing, A = CB - BB'CB / 2 (the correction of
    restricted likelihood, by moments: Patterson, Thompson 1971). A fit takes most where its columns vary as slowly as
    the noise does.
    """
    spread = np.concatenate([place.covariance(kernels) @ basis[place.rows] for place in places])
    other = spread - 0.5 * basis @ (basis.T @ spread)
    taken: FloatArray = np.sum([2.0 * _by_lag(place, basis, other, longest) for place in places], axis=0)
    return taken


def _by_lag(place: _Place, one: FloatArray, other: FloatArray, longest: int) -> FloatArray:
    """Sums of products of a place's rows of two (n, k), by lag; (SPEEDS, longest)."""
    return place.by_lag(one[place.rows] @ other[place.rows].T, longest)


def _places(dataset: Dataset, rows: BoolArray, residual: FloatArray) -> tuple[list[_Place], int]:
    """Places of the chosen rows, and how many rows BLOCK_S is at most."""
    velocity = np.abs(dataset.rows_of([trial.motion.velocity for trial in dataset.trials])[rows])
    speed = np.searchsorted(np.quantile(velocity, np.arange(1, SPEEDS) / SPEEDS), velocity)
    overall = _power(residual, speed) / np.maximum(np.bincount(speed, minlength=SPEEDS), 1)
    found, longest, start, seen = [], 1, 0, dataset.noise_seen[rows]
    for trial, there in zip(dataset.trials, dataset.trial_rows, strict=True):
        times_s = dataset.time_of(trial)
        if not len(times_s):
            continue
        period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0
        longest = max(longest, round(BLOCK_S / period_s))
        grid = np.round((times_s[rows[there]] - times_s[0]) / period_s).astype(np.int64)
        own = slice(start, start + len(grid))
        scale = _scale(residual[own], speed[own], overall) * seen[own]
        found += [
            _Place(slice(start + first, start + last), grid[first:last], speed[own][first:last], scale[first:last])
            for first, last in _cut(grid)
        ]
        start += len(grid)
    return found, longest


def _cut(grid: IntArray) -> Iterator[tuple[int, int]]:
    """Where the rows of a trial's grid (n,) are cut, so that no place is longer than LONGEST."""
    ends = np.flatnonzero(np.diff(grid // LONGEST)) + 1
    return pairwise([0, *ends.tolist(), len(grid)]) if len(grid) else iter(())


def _power(residual: FloatArray, speed: IntArray) -> FloatArray:
    return np.bincount(speed, residual**2, SPEEDS).astype(float)


def _scale(residual: FloatArray, speed: IntArray, overall: FloatArray) -> FloatArray:
    """Of each row (n,) of one trial: its power over that of all trials, of its kind, drawn to 1."""
    known = np.where(overall > 0.0, overall, 1.0)
    count = np.bincount(speed, minlength=SPEEDS)
    power = (_power(residual, speed) / known + FEWEST_ROWS) / (count + FEWEST_ROWS)
    scale: FloatArray = np.sqrt(np.where(overall > 0.0, power, 1.0))[speed]
    return scale


def _kernels(autocovariances: FloatArray) -> FloatArray:
    """Covariances by lag of each two kinds of rows, whose noise is one source by two filters; (SPEEDS, SPEEDS, lags).

    Autocovariances (SPEEDS, lags) are tapered to zero, so that of the largest lag and more there is none (Parzen).
    """
    longest = autocovariances.shape[1]
    lag = np.arange(longest) / longest
    taper = np.where(lag <= 0.5, 1.0 - 6.0 * lag**2 * (1.0 - lag), 2.0 * (1.0 - lag) ** 3)
    length = 2 * max(LONGEST, longest)
    even = np.zeros((SPEEDS, length))
    even[:, :longest] = taper * autocovariances
    even[:, length - longest + 1 :] = even[:, longest - 1 : 0 : -1]
    gains = np.sqrt(np.maximum(np.fft.rfft(even).real, 0.0))
    kernels: FloatArray = np.fft.irfft(gains[:, None] * gains, length)[:, :, : length // 2]
    return kernels
