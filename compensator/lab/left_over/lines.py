"""How surely a line stands out of noise: what cosine and sine gain at a frequency, over what they gain around it.

In noise alone a gain is an exponential variable, whatever the phase (Schuster 1898, Lomb 1976). The noise's density at
a frequency is the mean gain around, without the line's own. Noise that is learnt from all that a model leaves would
have the line in it, and hide it: what is periodic is no noise, but lies in a band of it.
"""

import numpy as np
from scipy.fft import next_fast_len

from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray

WIDTH = 4  # of a line, in frequencies that are looked at: none falls between two of them
MOST_GAIN = 5.0  # of one of several groups over the noise: noise alone has so much once in 150
STEP = 0.05  # of a sum's distribution, in gains of what counts most
NODES = 9  # of an integral over the noise
TINY = float(np.finfo(float).tiny)


def over_noise(
    at: FloatArray, gains: FloatArray, counts: FloatArray, reach: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """What groups of rows gain (k, m) over what they would by noise alone, and how many frequencies around tell that.

    The noise is that of all groups, as each counts (k,) in what is summed: those that count for little may have noise
    of another colour. A group's own scale is its mean over all frequencies. Of both sides that with more noise tells:
    where noise only ends there is no line.

    Args:
        at: frequencies, shape (m,).
        gains: of each group by each frequency.
        counts: of the groups.
        reach: of a line, to either side, and of what noise is alike over.
    """
    gains = gains / np.maximum(gains.mean(axis=1, keepdims=True), TINY)
    bounded = counts @ np.minimum(gains, MOST_GAIN) / (counts.sum() * (1.0 - float(np.exp(-MOST_GAIN))))
    above, below = _above(at, bounded, reach), _above(-at[::-1], bounded[::-1], reach)
    sides = [above, (below[0][::-1], below[1][::-1])]
    floor = np.max([total / np.maximum(count, 1) for total, count in sides], axis=0)
    return gains / np.maximum(floor, TINY), np.sum([count for _, count in sides], axis=0).astype(np.float64)


def _above(at: FloatArray, values: FloatArray, reach: tuple[float, float]) -> tuple[FloatArray, IntArray]:
    """Sums of the values (m,) that lie within a reach above each of their rising places (m,), and how many those are.

    Thousands of places, each beside all others, would take longer than all that is held against them.
    """
    first, end = (_beyond(at, one) for one in reach)
    sums = np.add.reduceat(np.append(values, 0.0), np.stack([first, end], axis=1).ravel())[::2]
    return np.where(end > first, sums, 0.0), end - first


def _beyond(at: FloatArray, reach: float) -> IntArray:
    """Of each of rising places (m,), the first that is farther above it than a reach; m where none is."""
    found = np.searchsorted(at, at + reach, side="right")
    # of even places one may lie just at the reach, where a sum is rounded to the other side than the difference is
    ends = np.concatenate([[-np.inf], at, [np.inf]])
    found -= ends[found] - at > reach
    found += ends[found + 1] - at <= reach
    return found


def is_peak(values: FloatArray) -> BoolArray:
    """Which of the values (n,) are as large as all within the width of a line, to both sides.

    At the ends, where one side is not known, none is: power that only rises towards the slow end is noise.
    """
    peaks = np.zeros(len(values), dtype=bool)
    if len(values) <= 2 * WIDTH:
        return peaks
    inner = slice(WIDTH, len(values) - WIDTH)
    peaks[inner] = values[inner] >= np.lib.stride_tricks.sliding_window_view(values, 2 * WIDTH + 1).max(axis=1)
    return peaks


def chance_of_one(gain: float, independent: float) -> float:
    """The chance of so large a gain over a mean of so many others (Snedecor's F of two and twice as many)."""
    return float((1.0 + gain / independent) ** -independent) if independent > 0.0 else 1.0


def chance_over_noise(gains: FloatArray, shares: FloatArray, independent: float) -> float:
    """The chance of such a sum of gains (n,), by shares (n,), over noise that is known from so many independent powers.

    The mean of so many exponential variables scatters by one over their root, which a sum of gains far in its tail
    takes for evidence: the chance is the mean over what the noise may be.
    """
    places, chances_of = np.polynomial.hermite_e.hermegauss(NODES)
    scales = np.exp(places / np.sqrt(max(independent, 1.0)))
    chances = [chance_of_sum(gains * scale, shares) for scale in scales]
    return float(chances_of @ chances / chances_of.sum())


def chance_of_sum(gains: FloatArray, shares: FloatArray) -> float:
    """The chance that as many exponential variables, each up to MOST_GAIN, have as large a sum, by shares (n,)."""
    step = STEP * float(shares.max())
    most = [int(np.ceil(MOST_GAIN * share / step)) for share in shares]
    size = next_fast_len(sum(most) + 1, real=True)
    passed, counted = np.ones(size // 2 + 1, dtype=complex), 0.0
    for share, highest in zip(shares, most, strict=True):
        edges = np.exp(-np.minimum(step / share * np.arange(highest + 1), MOST_GAIN))
        chances = np.append(edges[:-1] - edges[1:], edges[-1])
        passed *= np.fft.rfft(chances, size)
        counted += step * float(chances @ np.arange(highest + 1))
    sums = np.fft.irfft(passed, size)
    # each is counted at the lower end of its step, and so for less than it is on average
    missed = float(shares.sum()) * (1.0 - np.exp(-MOST_GAIN)) - counted
    at = int((float(shares @ np.minimum(gains, MOST_GAIN)) - missed) / step)
    return float(np.clip(sums[max(at, 0) :].sum(), 0.0, 1.0))
