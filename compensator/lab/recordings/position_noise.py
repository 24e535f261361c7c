"""What noise of the position puts into the acceleration, and its removal.

Counts make some noise. More comes from samples that are now fresh and now a millisecond old, as behind a drive that
updates its values at its own rate: in motion each is off by the way of that time. Twice differentiated, the density of
such noise grows with the fourth power of the frequency.

Noise of a regressor makes coefficients too small, and it makes what smooths an effort, as a filter does, too likely,
since the residual has the same noise (errors in variables: Fuller 1987). The remedy is the regressor's expected value,
given what was measured (regression calibration: Carroll et al. 2006, chapter 4). Frequency by frequency that is
Wiener's gain, 1 - N / S, with the density S of what was measured and N of its noise. Both are taken over a second at a
time: the noise grows with the speed, and a joint at a steady speed has no acceleration to show.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter
from scipy.signal import ShortTimeFFT, welch
from scipy.signal.windows import hann

from compensator.lab.recordings.recording import FloatArray

NOISE_ONLY = 0.75  # of half the sample rate: above, a position holds hardly any motion
SEGMENT_S = 4.0
WINDOW_S = 1.0  # tells frequencies 2 Hz apart
FEWEST_SAMPLES = 16  # of a window
STEPS = 4  # from a window to the next
NEIGHBOURS = 3  # frequencies and windows, over which a density is averaged: a single value scatters by itself


@dataclass(frozen=True, slots=True)
class PositionNoise:
    """Noise of one recorded position.

    Attributes:
        density: that of its highest frequencies, in its unit squared per Hz.
        windows: a second each, over which gains are found; None for a position that is shorter.
        gains: Wiener's, by frequency and window, shape (m, w).
        kept: a draw of what noise these gains leave in the acceleration, shape (n,).
    """

    density: float
    windows: ShortTimeFFT | None
    gains: FloatArray
    kept: FloatArray

    def removed_from(self, acceleration: FloatArray) -> FloatArray:
        """The acceleration (n,) as it is expected of a position with noise, after some low-pass."""
        if self.windows is None:
            return acceleration
        found: FloatArray = self.windows.istft(self.gains * self.windows.stft(acceleration), k1=len(acceleration))
        return found


def position_noise(position: FloatArray, mixed: float, rate_hz: float) -> PositionNoise:
    """Noise of a position, by what it has where a motion has nothing.

    Args:
        position: at a uniform rate, shape (n,), before any filter.
        mixed: by the interpolation that made it; see `mixed_by_interpolation`.
        rate_hz: of the samples.
    """
    density = _density(position, mixed, rate_hz)
    samples = max(int(WINDOW_S * rate_hz), FEWEST_SAMPLES)
    if len(position) < samples:
        return PositionNoise(density, None, np.empty((0, 0)), np.zeros(len(position)))
    window = hann(samples, sym=False)
    windows = ShortTimeFFT(window, samples // STEPS, rate_hz)
    # of second differences: large slow motion would leak from the window's low frequencies into all others; 0 at both
    # ends, where a joint that moves already would seem to be struck
    measured = windows.spectrogram(np.pad(np.diff(position, 2), 1))
    per_sample = windows.f / rate_hz
    white = (2.0 * np.sin(np.pi * per_sample)) ** 4 * _passed(per_sample, mixed)
    above = per_sample > 0.5 * NOISE_ONLY
    power = np.mean(measured[above] / white[above, None], axis=0)
    around = uniform_filter(measured, NEIGHBOURS)
    gains = np.clip(1.0 - power * white[:, None] / np.maximum(around, np.finfo(float).tiny), 0.0, 1.0)
    drawn = np.random.default_rng(len(position)).standard_normal(len(position) + 2)
    scale = rate_hz**2 * np.sqrt(power / float(window @ window))
    kept: FloatArray = windows.istft(gains * scale * windows.stft(np.diff(drawn, 2)), k1=len(position))
    return PositionNoise(density, windows, gains, kept)


def mixed_by_interpolation(even: FloatArray, time_s: FloatArray) -> float:
    """Mean of w (1 - w), where two samples that are weighted by 1 - w and w make a value: white noise loses by it.

    Args:
        even: times that values are wanted at.
        time_s: of the samples.
    """
    after = np.clip(np.searchsorted(time_s, even), 1, len(time_s) - 1)
    weight = np.clip((even - time_s[after - 1]) / (time_s[after] - time_s[after - 1]), 0.0, 1.0)
    return float(np.mean(weight * (1.0 - weight)))


def _density(position: FloatArray, mixed: float, rate_hz: float) -> float:
    at_hz, density = welch(position, rate_hz, nperseg=min(len(position), max(int(SEGMENT_S * rate_hz), 1)))
    above = at_hz > NOISE_ONLY * 0.5 * rate_hz
    return float(np.mean(density[above] / _passed(at_hz[above] / rate_hz, mixed))) if above.any() else 0.0


def _passed(per_sample: FloatArray, mixed: float) -> FloatArray:
    """Share of white noise that interpolation lets through, at frequencies in cycles per sample, shape (m,)."""
    passed: FloatArray = 1.0 - 2.0 * mixed * (1.0 - np.cos(2.0 * np.pi * per_sample))
    return passed
