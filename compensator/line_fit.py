"""Ordinary least squares of a few coefficients, with 95 % intervals of them and of their quotients."""

from dataclasses import dataclass
from math import inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

CONFIDENCE = 0.95


class Interval(NamedTuple):
    """One identified parameter.

    Attributes:
        value, low, high: in the parameter's unit; low and high are NaN where the data do not determine it.
        note: "" or why the value is to be read with care.
    """

    value: float
    low: float = nan
    high: float = nan
    note: str = ""


@dataclass(frozen=True, slots=True)
class Line:
    """A linear relation: coefficients, their covariance, Student's t, standard deviation of the residuals.

    `told` is False where columns rise and fall together: they share out their effect in any way.
    """

    told: bool
    values: FloatArray
    covariance: FloatArray
    quantile: float
    residual: float

    def coefficient(self, index: int) -> Interval:
        """A coefficient."""
        return self._interval(float(self.values[index]), np.eye(len(self.values))[index])

    def inverse(self) -> Interval:
        """1 / the first coefficient."""
        if self.values[0] == 0.0:
            return Interval(inf, -inf, inf)
        gradient = np.zeros(len(self.values))
        gradient[0] = -1.0 / self.values[0] ** 2
        return self._interval(1.0 / float(self.values[0]), gradient)

    def ratio(self, index: int) -> Interval:
        """- a coefficient / the first one."""
        if self.values[0] == 0.0:
            return Interval(inf, -inf, inf)
        gradient = np.zeros(len(self.values))
        gradient[index] = -1.0 / self.values[0]
        gradient[0] = self.values[index] / self.values[0] ** 2
        return self._interval(-float(self.values[index] / self.values[0]), gradient)

    def _interval(self, value: float, gradient: FloatArray) -> Interval:
        half = self.quantile * float(np.sqrt(gradient @ self.covariance @ gradient)) if self.told else inf
        return Interval(value, value - half, value + half)


def t_quantile(freedom: int) -> float:
    """Half width of an interval of `CONFIDENCE` over the standard error, from so many degrees of freedom (Student)."""
    from scipy.special import stdtrit  # imported when needed: every command starts with this file

    return float(stdtrit(freedom, 0.5 + CONFIDENCE / 2.0))


def fit_line(columns: FloatArray, response: FloatArray) -> Line:
    """Least squares.

    Args:
        columns: shape (n, k), n above k.
        response: shape (n,); the noise is its.
    """
    freedom = columns.shape[0] - columns.shape[1]
    scales = np.max(np.abs(columns), axis=0)
    scales[scales == 0.0] = 1.0
    values, _, rank, _ = np.linalg.lstsq(columns / scales, response, rcond=1e-9)
    residual = float(np.sqrt(np.sum((response - columns / scales @ values) ** 2) / freedom))
    told = bool(rank == columns.shape[1])
    gram = columns.T @ columns / np.outer(scales, scales)
    covariance = residual**2 * (np.linalg.inv(gram) if told else gram) / np.outer(scales, scales)
    quantile = t_quantile(freedom)
    return Line(told, values / scales, covariance, quantile, residual)
