"""What a complete model would leave: its autocovariance, and what of it any direction of the rows holds by chance.

A bound on how far chance goes needs the noise alone, so it is learnt from what is left once the best candidates are in
the model. Residuals are coloured, by filters and by what drives them, so that how much a direction holds depends on how
quickly it varies; one number of rows per independent row cannot say it (Priestley 1981, ch. 6). What friction makes of
them lies along the path, and so lasts the longer the slower the motion: slow, middling and fast rows each have noise of
their own colour, of one source (a filter that changes with the speed: Priestley 1965). Static friction scatters from
stop to stop beside that (`stops`).
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.special import fdtrc, fdtri

from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import BLOCK_S, FEWEST_ROWS, Dataset
from compensator.lab.screening.stops import StopToStop

ComplexArray = NDArray[np.complex128]
Spectra = list[ComplexArray]  # of columns, by kind of row

SPEEDS = 3  # kinds of rows, slow to fast, as many of each
STEADIEST = 0.5  # share of the noise, at any frequency, that is left to what does not last a stroke: both look alike
PASSES = 3  # of learning what a fit takes from the noise
DRAWS = 9999


@dataclass(frozen=True)
class _Place:
    """Where one trial's rows are.

    Attributes:
        rows: among all rows.
        grid: on the trial's even grid, from 0, shape (n,).
        speed: kind of each row, 0 .. SPEEDS - 1, shape (n,).
        power: of the trial's noise over that of all trials, of each kind, shape (SPEEDS,).
    """

    rows: slice
    grid: IntArray
    speed: IntArray
    power: FloatArray

    @cached_property
    def length(self) -> int:
        """Even, of a grid on which the rows' products by lag do not meet those from the other end."""
        return 2 * int(next_fast_len(int(self.grid[-1]) + 1, real=True))

    @cached_property
    def kinds(self) -> list[tuple[int, IntArray, IntArray]]:
        """Each kind that has rows here, which of the rows these are, and where on the grid."""
        rows = [(int(speed), np.flatnonzero(self.speed == speed)) for speed in np.unique(self.speed)]
        return [(speed, inside, self.grid[inside]) for speed, inside in rows]

    def spectra(self, values: FloatArray) -> Spectra:
        """Of columns (n, k), where rows are of each kind and 0 elsewhere; (length // 2 + 1, k) each."""
        return [np.fft.rfft(_filled(grid, values[inside], self.length), axis=0) for _, inside, grid in self.kinds]


@dataclass(frozen=True)
class Noise:
    """Noise of each trial's rows, of one source, coloured by the speed; and from stop to stop.

    Attributes:
        places: of the trials.
        autocovariances: of each speed, by lag in rows, tapered to zero (Parzen), shape (SPEEDS, lags).
        known_from: independent stretches of BLOCK_S, less one: how well the noise is known.
        outweighed: what is missing is larger than the noise, so that what a formula leaves of it tells formulas apart
            better than the noise does.
        strokes: between stops; None where static friction is not in the model.
        from_stop_to_stop: variance of the factor of static friction.
        evening: factors of strokes that make rows even, shape (S,); None where all are.
    """

    places: tuple[_Place, ...]
    autocovariances: FloatArray
    known_from: int
    outweighed: bool
    strokes: StopToStop | None = None
    from_stop_to_stop: float = 0.0
    evening: FloatArray | None = None

    @classmethod
    def learnt(
        cls,
        dataset: Dataset,
        rows: BoolArray,
        left: tuple[FloatArray, FloatArray],
        before: float,
        strokes: StopToStop | None = None,
    ) -> "Noise":
        """From what is left.

        Args:
            dataset: of the rows.
            rows: chosen, shape (N,).
            left: basis (n, b) of what was fitted to the chosen rows, and the weighted residual (n,) that it left.
            before: power of what was left of these rows by the model alone.
            strokes: of the chosen rows; None where static friction is not in the model.
        """
        basis, residual = left
        found, longest = _places(dataset, rows, residual)
        products, pairs = _products(residual, found, longest)
        free = len(residual) / max(len(residual) - basis.shape[1], 1)
        stretches = len(np.unique(dataset.block_index[rows]))
        outweighed = before > 2.0 * float(residual @ residual)
        noise = cls(tuple(found), _tapered(free * products, pairs), max(stretches - 1, 1), outweighed)
        spectra = [place.spectra(basis[place.rows]) for place in found]
        noise = noise._given_back(products, pairs, lambda one: one.taken(basis, spectra))
        if strokes is None:
            return noise
        alone = [_of_strokes(strokes, place) for place in found]
        cleared = strokes.scaled(residual[:, None], np.zeros_like(strokes.power))[:, 0]
        products, _ = _products(cleared, found, longest)
        other = noise._given_back(products, pairs, lambda one: one.taken(basis, spectra) + one.taken_by(alone))
        variance = strokes.variance(basis, residual, other.covariance)
        if variance == 0.0:
            return noise
        shared, _ = _products(strokes.share, _within(strokes, found), longest)
        noise = replace(noise, autocovariances=_less(noise.autocovariances, _tapered(variance * shared, pairs)))
        evening = strokes.evening(variance, noise.covariance)
        return replace(noise, strokes=strokes, from_stop_to_stop=variance, evening=evening)

    def evened(self, values: FloatArray) -> FloatArray:
        """Weighted rows of columns (n, k) as their evidence counts: of static friction in slow strokes, little."""
        if self.strokes is None or self.evening is None:
            return values
        return self.strokes.scaled(values, self.evening)

    def as_measured(self, values: FloatArray) -> FloatArray:
        """What `evened` was given, from what it returned, (n, k)."""
        if self.strokes is None or self.evening is None:
            return values
        return self.strokes.scaled(values, 1.0 / self.evening)

    @cached_property
    def _gains(self) -> list[list[FloatArray]]:
        """Of noise from white to the colour of each kind of each place, by frequency, shape (length // 2 + 1, 1)."""
        return [
            [
                np.sqrt(place.power[speed] * spectral_density(self.autocovariances[speed], place.length))[:, None]
                for speed, _, _ in place.kinds
            ]
            for place in self.places
        ]

    def covariance(self, directions: FloatArray) -> FloatArray:
        """Of what noise puts into each of the directions (n, k) of evened rows: shape (k, k)."""
        directions = self.evened(directions)
        total = np.zeros((directions.shape[1], directions.shape[1]))
        for place, gains in zip(self.places, self._gains, strict=True):
            passed = _passed(gains, place.spectra(directions[place.rows]))
            passed[1:-1] *= np.sqrt(2.0)  # negative frequencies, too
            total += (passed.real.T @ passed.real + passed.imag.T @ passed.imag) / place.length
        if self.strokes is not None:
            sums = self.strokes.sums(directions)
            total += self.from_stop_to_stop * (sums.T @ sums)
        symmetric: FloatArray = 0.5 * (total + total.T)
        return symmetric

    def _given_back(self, products: FloatArray, pairs: FloatArray, taken: Callable[["Noise"], FloatArray]) -> "Noise":
        """The same, its autocovariances those of products (SPEEDS, lags) and of what was taken from them."""
        noise = self
        for _ in range(PASSES):
            noise = replace(noise, autocovariances=_tapered(products + taken(noise), pairs))
        return noise

    def taken(self, basis: FloatArray, spectra: list[Spectra]) -> FloatArray:
        """What a fit of an orthonormal basis (n, b) of rows as they were measured takes from noise's products by lag.

        A residual is e - BB'e, so that of its covariance BA' + AB' is missing, A = CB - BB'CB / 2 (the correction of
        restricted likelihood, by moments: Patterson, Thompson 1971). A fit takes most where its columns vary as slowly
        as the noise does. Shape (SPEEDS, lags).

        Args:
            basis: that was fitted.
            spectra: of its rows in each place.
        """
        each = list(zip(self.places, self._gains, spectra, strict=True))
        spread = np.concatenate([_spread(place, gains, own) for place, gains, own in each])
        other = spread - 0.5 * basis @ (basis.T @ spread)
        products = [self._crossed(place, own, other[place.rows]) for place, _, own in each]
        found: FloatArray = np.sum(products, axis=0)
        return found

    def taken_by(self, strokes: list[tuple[FloatArray, Spectra]]) -> FloatArray:
        """The same of a fit of each stroke's share of static friction (`_of_strokes`); shape (SPEEDS, lags)."""
        products = np.zeros((SPEEDS, self.autocovariances.shape[1]))
        for place, gains, (basis, spectra) in zip(self.places, self._gains, strokes, strict=True):
            spread = _spread(place, gains, spectra)
            products += self._crossed(place, spectra, spread - 0.5 * basis @ (basis.T @ spread))
        return products

    def _crossed(self, place: _Place, spectra: Spectra, other: FloatArray) -> FloatArray:
        """Sums of products by lag of one trial's columns, by their spectra, and others (n, k), both ways, by kind."""
        length, longest = place.length, self.autocovariances.shape[1]
        lags = min(longest, length // 2)
        products = np.zeros((SPEEDS, longest))
        for (speed, _, _), a, b in zip(place.kinds, spectra, place.spectra(other), strict=True):
            both = np.sum(a.real * b.real + a.imag * b.imag, axis=1)
            products[speed, :lags] = 2.0 * np.fft.irfft(both, length)[:lags]
        return products

    def chance(self, strength_found: float, rank: int) -> float:
        """The chance that noise alone is as strong in one block of that rank (Snedecor's F: the noise is learnt)."""
        return float(fdtrc(rank, self.known_from, strength_found / rank))

    def joint_chances(self, covariance: FloatArray, blocks: Sequence[slice]) -> Callable[[float], float]:
        """How likely noise alone brings any of the blocks' own chances down to a given one.

        Args:
            covariance: of all blocks' shares, shape (K, K).
            blocks: which of them each block has.
        """
        powers, axes = np.linalg.eigh(covariance)
        root = axes * np.sqrt(np.maximum(powers, 0.0))
        generator = np.random.default_rng(0)
        drawn = root @ generator.standard_normal((DRAWS, len(powers))).T
        known = generator.chisquare(self.known_from, DRAWS) / self.known_from
        strongest: dict[int, FloatArray] = {}  # of each draw, by rank
        for own in blocks:
            shares = drawn[own]
            rank = len(shares)
            strengths = np.einsum("kn,kn->n", np.linalg.pinv(covariance[own, own], 1e-9, True) @ shares, shares)
            strongest[rank] = np.maximum(strongest.get(rank, 0.0), strengths / known)

        def chance(own: float) -> float:
            reached = [
                found >= rank * float(fdtri(rank, self.known_from, 1.0 - own)) * (1.0 - 1e-9)
                for rank, found in strongest.items()
            ]
            return (1.0 + float(np.any(reached, axis=0).sum())) / (1.0 + DRAWS)

        return chance


def _of_strokes(strokes: StopToStop, place: _Place) -> tuple[FloatArray, Spectra]:
    """The share of static friction in each stroke of a place, of unit norm, a column each; and their spectra."""
    there, own = np.unique(strokes.index[place.rows], return_inverse=True)
    basis = np.where(own[:, None] == np.arange(len(there)), strokes.share[place.rows][:, None], 0.0)
    size = np.linalg.norm(basis, axis=0)
    basis = basis / np.where(size > 0.0, size, 1.0)
    return basis, place.spectra(basis)


def strength(share: FloatArray, covariance: FloatArray) -> float:
    """How far a share (k,) of the residual is beyond noise of a covariance (k, k): chi-squared of k, if it is noise."""
    return float(share @ np.linalg.lstsq(covariance, share, rcond=1e-9)[0])


def _places(dataset: Dataset, rows: BoolArray, residual: FloatArray) -> tuple[list[_Place], int]:
    """Places of the chosen rows, and how many rows BLOCK_S is at most."""
    velocity = np.abs(dataset.rows_of([trial.motion.velocity for trial in dataset.trials])[rows])
    speed = np.searchsorted(np.quantile(velocity, np.arange(1, SPEEDS) / SPEEDS), velocity)
    overall = _power_by_kind(residual, speed) / np.maximum(np.bincount(speed, minlength=SPEEDS), 1)
    found, longest, start = [], 1, 0
    for trial, there in zip(dataset.trials, dataset.trial_rows, strict=True):
        times_s = dataset.time_of(trial)
        period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0
        longest = max(longest, round(BLOCK_S / period_s))
        chosen = rows[there]
        if chosen.any():
            grid = np.round((times_s[chosen] - times_s[chosen][0]) / period_s).astype(np.int64)
            own = slice(start, start + len(grid))
            found.append(_Place(own, grid, speed[own], _power(residual[own], speed[own], overall)))
            start += len(grid)
    return found, longest


def _within(strokes: StopToStop, places: list[_Place]) -> Iterator[_Place]:
    """The places cut at every stop."""
    for place in places:
        index = strokes.index[place.rows]
        ends = [0, *(np.flatnonzero(np.diff(index)) + 1), len(index)]
        for first, last in pairwise(int(end) for end in ends):
            own = slice(place.rows.start + first, place.rows.start + last)
            yield _Place(own, place.grid[first:last] - place.grid[first], place.speed[first:last], place.power)


def _power_by_kind(residual: FloatArray, speed: IntArray) -> FloatArray:
    return np.bincount(speed, residual**2, SPEEDS).astype(float)


def _power(residual: FloatArray, speed: IntArray, overall: FloatArray) -> FloatArray:
    """Of one trial's residual (n,) over that of all, by kind of row, drawn to 1; shape (SPEEDS,)."""
    known = np.where(overall > 0.0, overall, 1.0)
    count = np.bincount(speed, minlength=SPEEDS)
    power: FloatArray = (_power_by_kind(residual, speed) / known + FEWEST_ROWS) / (count + FEWEST_ROWS)
    return np.where(overall > 0.0, power, 1.0)


def _products(values: FloatArray, places: Iterable[_Place], longest: int) -> tuple[FloatArray, FloatArray]:
    """Sums of products of two of the values (n,), of one place and kind, by lag, and of how many; (SPEEDS, longest)."""
    products, pairs = np.zeros((SPEEDS, longest)), np.zeros((SPEEDS, longest))
    for place in places:
        lags = min(longest, place.length // 2)
        for speed, inside, grid in place.kinds:
            filled = np.zeros((2, place.length))
            filled[0, grid], filled[1, grid] = values[place.rows][inside], 1.0
            spectra = np.abs(np.fft.rfft(filled, axis=1)) ** 2
            found = np.fft.irfft(spectra, place.length, axis=1)[:, :lags]
            products[speed, :lags] += found[0]
            pairs[speed, :lags] += np.round(found[1])
    return products, pairs


def _tapered(products: FloatArray, pairs: FloatArray) -> FloatArray:
    """Autocovariances (SPEEDS, lags) of sums of products; of the largest lag and more there is none (Parzen)."""
    longest = products.shape[1]
    lag = np.arange(longest) / longest
    taper = np.where(lag <= 0.5, 1.0 - 6.0 * lag**2 * (1.0 - lag), 2.0 * (1.0 - lag) ** 3)
    tapered: FloatArray = taper * products / np.maximum(pairs, 1.0)
    return tapered


def _less(whole: FloatArray, part: FloatArray) -> FloatArray:
    """Autocovariances (SPEEDS, lags) without a part of them, still those of a noise: at no frequency below zero."""
    lags = whole.shape[1]
    kept = [
        np.maximum(spectral_density(a - b, 2 * lags), STEADIEST * spectral_density(a, 2 * lags))
        for a, b in zip(whole, part, strict=True)
    ]
    found: FloatArray = np.fft.irfft(np.array(kept), 2 * lags, axis=1)[:, :lags]
    return found


def _spread(place: _Place, gains: list[FloatArray], spectra: Spectra) -> FloatArray:
    """The covariance of one trial's rows, but for what lasts a stroke, times columns, by their spectra; (n, k)."""
    passed = _passed(gains, spectra)
    found = np.zeros((len(place.grid), passed.shape[1]))
    for gain, (_, inside, grid) in zip(gains, place.kinds, strict=True):
        found[inside] = np.fft.irfft(gain * passed, place.length, axis=0)[grid]
    return found


def _passed(gains: list[FloatArray], spectra: Spectra) -> ComplexArray:
    """What noise of each kind's colour makes of them, together."""
    passed = np.zeros_like(spectra[0])
    for gain, spectrum in zip(gains, spectra, strict=True):
        passed += gain * spectrum
    return passed


def _filled(grid: IntArray, values: FloatArray, length: int) -> FloatArray:
    """Values (n, k) on an even grid of so many places; zero where there is no row."""
    found = np.zeros((length, values.shape[1]))
    found[grid] = values
    return found


def spectral_density(autocovariance: FloatArray, length: int) -> FloatArray:
    """Spectral density of an autocovariance (lags,) on so many places of an even grid, as rfft has it; none below 0."""
    lags = min(len(autocovariance), length // 2)
    kernel = np.zeros(length)
    kernel[:lags] = autocovariance[:lags]
    kernel[length - lags + 1 :] = autocovariance[1:lags][::-1]
    density: FloatArray = np.maximum(np.fft.rfft(kernel).real, 0.0)
    return density
