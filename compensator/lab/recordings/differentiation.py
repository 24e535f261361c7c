"""Rates of change of sampled signals.

Plain central differences lose (w T)^2 / 6 of a rate at angular frequency w: twice applied, at a cut-off of an eighth of
the sampling rate, a tenth of the acceleration, which then looks like an elastic joint. Eighth-order differences lose
(w T)^8 / 630 (Fornberg 1988).
"""

import numpy as np

from compensator.lab.recordings.recording import FloatArray

WEIGHTS = np.array([4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0])  # of the differences over 2, 4, 6, 8 samples


def rate_of_change(values: FloatArray, rate_hz: float) -> FloatArray:
    """Derivative of values (n,) sampled at a uniform rate; of second order in the four samples at each end."""
    derived: FloatArray = np.gradient(values, 1.0 / rate_hz)
    reach = len(WEIGHTS)
    inner = slice(reach, len(values) - reach)
    if len(values) > 2 * reach:
        total = np.zeros(len(values) - 2 * reach)
        for distance, weight in enumerate(WEIGHTS, 1):
            ahead = values[reach + distance : len(values) - reach + distance]
            total += weight * (ahead - values[reach - distance : len(values) - reach - distance])
        derived[inner] = total * rate_hz
    return derived
