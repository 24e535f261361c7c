"""Motions that tell effects apart: fast and slow, large and small, both ways. Each starts and ends at rest.

A waveform is made for a peak amplitude A [rad] and a peak speed V [rad/s], which it keeps to.
"""

from collections.abc import Callable

import numpy as np

from compensator.lab.recordings.recording import FloatArray

Shape = Callable[[FloatArray, float, float], FloatArray]
FADE_S = 0.5


def _sine(speed_share: float, amplitude_share: float = 1.0) -> Shape:
    def shape(time_s: FloatArray, amplitude_rad: float, speed_rad_s: float) -> FloatArray:
        reach_rad = amplitude_share * amplitude_rad
        return reach_rad * np.sin(speed_share * speed_rad_s / reach_rad * time_s)

    return shape


def _multisine(time_s: FloatArray, amplitude_rad: float, speed_rad_s: float) -> FloatArray:
    # frequencies that share no period within a trial, amplitudes falling with frequency, phases far from a common peak
    ratios = np.array([1.0, 2.3, 3.9, 6.1, 9.7])
    phases = np.pi * np.arange(5) ** 2 / 5
    slowest_rad_s = 0.5 * speed_rad_s / amplitude_rad
    waves = np.sin(slowest_rad_s * ratios * time_s[:, None] + phases) / ratios
    return np.asarray(amplitude_rad * waves.sum(axis=1) / np.sum(1.0 / ratios))


def _sweep(time_s: FloatArray, amplitude_rad: float, speed_rad_s: float) -> FloatArray:
    """sin(t^2): from standstill to the peak speed, at half the amplitude."""
    reach_rad = 0.5 * amplitude_rad
    duration_s = max(float(time_s[-1]), FADE_S)
    return reach_rad * np.sin(0.5 * speed_rad_s / reach_rad * time_s**2 / duration_s)


def _triangles(time_s: FloatArray, amplitude_rad: float, speed_rad_s: float) -> FloatArray:
    """Up and down again at four steady speeds, each half the one before, from slow to fast."""
    shares = np.array([1.0, 2.0, 4.0, 8.0]) / 16.0
    part_s = float(time_s[-1]) / len(shares)
    part = np.minimum((time_s / part_s).astype(int), len(shares) - 1)
    within = time_s / part_s - part
    way_rad = np.minimum(shares * speed_rad_s * part_s / 4, amplitude_rad)
    # 0 -> +way -> -way -> 0 within each part
    return np.asarray(way_rad[part] * (2 / np.pi) * np.arcsin(np.sin(2 * np.pi * within)))


WAVEFORMS: dict[str, Shape] = {
    "slow-sine": _sine(speed_share=0.125),
    "fast-sine": _sine(speed_share=1.0),
    "small-sine": _sine(speed_share=0.5, amplitude_share=0.2),
    "multisine": _multisine,
    "sweep": _sweep,
    "triangles": _triangles,
}


def sampled(name: str, duration_s: float, period_s: float, amplitude_rad: float, speed_rad_s: float) -> FloatArray:
    """Set points of a waveform.

    Returns:
        Position [rad] and speed [rad/s], shape (cycles, 2); within the amplitude and the peak speed.
    """
    time_s: FloatArray = np.arange(1, round(duration_s / period_s) + 1, dtype=np.float64) * period_s
    position_rad = WAVEFORMS[name](time_s, amplitude_rad, speed_rad_s) * fade(time_s, duration_s)
    velocity_rad_s = np.gradient(position_rad, period_s)
    # the fade and the sum of waves may exceed either bound: scale down, never up
    excess = max(
        float(np.max(np.abs(position_rad))) / amplitude_rad, float(np.max(np.abs(velocity_rad_s))) / speed_rad_s, 1.0
    )
    return np.column_stack([position_rad, velocity_rad_s]) / excess


def fade(time_s: FloatArray, duration_s: float) -> FloatArray:
    """Envelope: from 0 to 1 in the first half second, and back in the last."""
    nearest_s = np.minimum(time_s, duration_s - time_s)
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.clip(nearest_s / FADE_S, 0.0, 1.0)))
