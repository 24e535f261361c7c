"""What a complete model would leave: its autocovariance, and what of it any direction of the rows holds by chance.

A bound on how far chance goes needs the noise alone, so it is learnt from what is left once the best candidates are in
the model. Residuals are coloured, by filters and by what drives them, so that how much a direction holds depends on how
quickly it varies; one number of rows per independent row cannot say it (Priestley 1981, ch. 6).
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import f as fisher

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray
from compensator.lab.rows.dataset import Dataset

MEMORY_S = 2.0  # beyond which residuals are taken to be independent, as stretches are
SHRINK_ROWS = 20  # a trial's own scale is drawn to that of all by so many rows
DRAWS = 9999


@dataclass(frozen=True)
class _Place:
    """Where one trial's rows are: among all rows, and on the trial's even grid; and its noise over that of all."""

    rows: slice
    grid: FloatArray
    power: float


@dataclass(frozen=True)
class Noise:
    """Stationary noise of each trial's rows.

    Attributes:
        places: of the trials.
        autocovariance: by lag in rows, tapered to zero (Parzen), shape (lags,).
        known_from: independent stretches of MEMORY_S, less one: how well the noise is known.
        outweighed: what is missing is larger than the noise, so that what a formula leaves of it tells formulas apart
            better than the noise does.
    """

    places: tuple[_Place, ...]
    autocovariance: FloatArray
    known_from: int
    outweighed: bool

    @classmethod
    def learnt(cls, dataset: Dataset, rows: BoolArray, residual: FloatArray, taken: int, before: float) -> "Noise":
        """From what is left.

        Args:
            dataset: of the rows.
            rows: chosen, shape (N,).
            residual: weighted, of the chosen rows, shape (n,).
            taken: columns that were fitted to these rows.
            before: power of what was left of these rows by the model alone.
        """
        found, longest, start = [], 1, 0
        for index, trial in enumerate(dataset.trials):
            times_s = dataset.time_of(trial)
            period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0
            longest = max(longest, round(MEMORY_S / period_s))
            chosen = rows[dataset.trial_index == index]
            if chosen.any():
                grid = np.round((times_s[chosen] - times_s[chosen][0]) / period_s).astype(np.int64)
                found.append((slice(start, start + len(grid)), grid))
                start += len(grid)
        overall = float(np.mean(residual**2)) if len(residual) else 0.0
        free = len(residual) / max(len(residual) - taken, 1)
        places = tuple(_Place(own, grid, _power(residual[own], overall)) for own, grid in found)
        autocovariance = free * _autocovariance([(residual[p.rows], p.grid) for p in places], longest)
        stretches = len(np.unique(dataset.block_index[rows]))
        outweighed = before > 2.0 * overall * len(residual)
        return cls(places, autocovariance, max(stretches - 1, 1), outweighed)

    def covariance(self, directions: FloatArray) -> FloatArray:
        """Of what noise puts into each of the directions (n, k): shape (k, k)."""
        total = np.zeros((directions.shape[1], directions.shape[1]))
        for place in self.places:
            own = directions[place.rows]
            span = int(place.grid[-1]) + 1
            lags = min(len(self.autocovariance), span)
            length = 2 * span
            kernel = np.zeros(length)
            kernel[:lags] = self.autocovariance[:lags]
            kernel[length - lags + 1 :] = self.autocovariance[1:lags][::-1]
            spread = np.zeros((length, own.shape[1]))
            spread[place.grid] = own
            spectrum = np.fft.rfft(spread, axis=0) * np.fft.rfft(kernel).real[:, None]
            total += place.power * (own.T @ np.fft.irfft(spectrum, length, axis=0)[place.grid])
        symmetric: FloatArray = 0.5 * (total + total.T)
        return symmetric

    def chance(self, strength_found: float, rank: int) -> float:
        """The chance that noise alone is as strong in one block of that rank (Snedecor's F: the noise is learnt)."""
        return float(fisher.sf(strength_found / rank, rank, self.known_from))

    def joint_chance(self, covariance: FloatArray, blocks: list[slice], least: float, seed: int = 0) -> float:
        """The chance that noise alone brings any of the blocks' own chances down to `least`.

        Args:
            covariance: of all blocks' shares, shape (K, K).
            blocks: which of them each block has.
            least: the lowest chance found.
            seed: of the draws.
        """
        powers, axes = np.linalg.eigh(covariance)
        root = axes * np.sqrt(np.maximum(powers, 0.0))
        generator = np.random.default_rng(seed)
        drawn = generator.standard_normal((DRAWS, len(powers))) @ root.T
        known = generator.chisquare(self.known_from, DRAWS) / self.known_from
        reached = np.zeros(DRAWS, dtype=bool)
        for own in blocks:
            shares = drawn[:, own]
            rank = shares.shape[1]
            solved = np.linalg.lstsq(covariance[own, own], shares.T, rcond=1e-9)[0].T
            most = rank * float(fisher.isf(least, rank, self.known_from))
            reached |= np.einsum("nk,nk->n", shares, solved) / known >= most * (1.0 - 1e-9)
        return (1.0 + float(reached.sum())) / (1.0 + DRAWS)


def strength(share: FloatArray, covariance: FloatArray) -> float:
    """How far a share (k,) of the residual is beyond noise of a covariance (k, k): chi-squared of k, if it is noise."""
    return float(share @ np.linalg.lstsq(covariance, share, rcond=1e-9)[0])


def _power(residual: FloatArray, overall: float) -> float:
    if overall == 0.0:
        return 1.0
    return (float(residual @ residual) / overall + SHRINK_ROWS) / (len(residual) + SHRINK_ROWS)


def _autocovariance(parts: list[tuple[FloatArray, FloatArray]], longest: int) -> FloatArray:
    """Pooled over trials, of values (n,) on places (n,) of an even grid; lags of `longest` and more are none."""
    products, pairs = np.zeros(longest), np.zeros(longest)
    for values, grid in parts:
        span = int(grid[-1]) + 1
        filled = np.zeros((2, 2 * span))
        filled[0, grid], filled[1, grid] = values, 1.0
        spectra = np.abs(np.fft.rfft(filled, axis=1)) ** 2
        lags = min(longest, span)
        found = np.fft.irfft(spectra, 2 * span, axis=1)[:, :lags]
        products[:lags] += found[0]
        pairs[:lags] += np.round(found[1])
    lag = np.arange(longest) / longest
    taper = np.where(lag <= 0.5, 1.0 - 6.0 * lag**2 * (1.0 - lag), 2.0 * (1.0 - lag) ** 3)
    tapered: FloatArray = taper * products / np.maximum(pairs, 1.0)
    return tapered
