"""The likeliest variance components of residuals, whatever the coefficients of the base are.

Restricted likelihood (Patterson, Thompson 1971): what a base could explain of the residuals speaks for no component.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotri
from scipy.optimize import minimize

from compensator.lab.recordings.recording import FloatArray

SMALLEST, LARGEST = 1e-5, 50.0  # of a component, as a share of the residual's power
WHITE = 1e-3  # of it is white, at least
STEPS = 60


@dataclass(frozen=True)
class Part:
    """Rows that have nothing but the base's coefficients and the variances in common with other parts.

    Attributes:
        base: columns that are fitted anew, shape (c, b).
        residual: of unit noise, that some fit of the base has left, shape (c,).
        kernels: covariance by each component of unit size, the first white, shape (k, c, c).
    """

    base: FloatArray
    residual: FloatArray
    kernels: FloatArray

    @property
    def without_last(self) -> "Part":
        """The same rows, and all components but the last."""
        return Part(self.base, self.residual, self.kernels[:-1])


@dataclass(frozen=True)
class Likelihood:
    """Restricted log-likelihood, its gradient (k,), and what the precision makes of each part's residual (c,)."""

    value: float
    gradient: FloatArray
    weighed: list[FloatArray]


class Likeliest(NamedTuple):
    """The likeliest variances (k,), the same as shares (k,) of the residual's power, and their likelihood."""

    variances: FloatArray
    shares: FloatArray
    likelihood: Likelihood


def likeliest(parts: Sequence[Part], start: FloatArray | None = None) -> Likeliest:
    """The likeliest variances of components.

    Args:
        parts: all rows.
        start: shares of the first components, where they are about known, shape (up to k,).
    """
    power = float(np.mean(np.concatenate([part.residual for part in parts]) ** 2)) or 1.0
    count = sum(len(part.residual) for part in parts)
    own = np.sum([np.trace(part.kernels, axis1=1, axis2=2) for part in parts], axis=0) / count
    scale = power / np.where(own > 0.0, own, 1.0)
    begin = np.full(len(scale), 0.3 / len(scale))
    begin[0] = 0.5
    if start is not None:
        begin = np.append(np.maximum(start, 10.0 * SMALLEST), np.full(len(scale) - len(start), 0.05))

    def unlikely(logarithms: FloatArray) -> tuple[float, FloatArray]:
        variances = scale * np.exp(logarithms)
        found = likelihood(variances, parts)
        return -found.value, -variances * found.gradient

    bounds = [(np.log(WHITE), np.log(LARGEST)), *([(np.log(SMALLEST), np.log(LARGEST))] * (len(scale) - 1))]
    best = minimize(
        unlikely, np.log(begin), jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": STEPS, "ftol": 1e-7}
    )
    shares: FloatArray = np.exp(best.x)
    return Likeliest(scale * shares, shares, likelihood(scale * shares, parts))


def likelihood(variances: FloatArray, parts: Sequence[Part]) -> Likelihood:
    """Of the residuals, whatever the base's coefficients are, by variances (k,)."""
    precisions, volume = [], 0.0
    for part in parts:
        precision, own = _inverse_of(np.tensordot(variances, part.kernels, 1))
        precisions.append(precision)
        volume += own
    sides = [precision @ part.base for precision, part in zip(precisions, parts, strict=True)]
    normal = np.sum([side.T @ part.base for side, part in zip(sides, parts, strict=True)], axis=0)
    moment = np.sum([side.T @ part.residual for side, part in zip(sides, parts, strict=True)], axis=0)
    powers, axes = np.linalg.eigh(normal)
    solid = powers > 1e-10 * powers[-1]  # rows may not tell all of the base's columns apart
    half = axes[:, solid] / np.sqrt(powers[solid])
    again = half @ (half.T @ moment)
    weighed, fits, gradient = [], 0.0, np.zeros(len(variances))
    for precision, side, part in zip(precisions, sides, parts, strict=True):
        left = precision @ (part.residual - part.base @ again)
        shared = side @ half
        unexplained = np.outer(left, left) - (precision - shared @ shared.T)
        gradient += 0.5 * (part.kernels.reshape(len(variances), -1) @ unexplained.ravel())
        fits += float(part.residual @ left)
        weighed.append(left)
    value = -0.5 * (volume + float(np.sum(np.log(powers[solid]))) + fits)
    return Likelihood(value, gradient, weighed)


@dataclass(frozen=True)
class CellsOfTrial:
    """Cells of a trial, each the mean of its rows, of unit noise.

    Attributes:
        index: of the trial; time_s: of each cell, shape (c,).
        size: what wanders has of each, shape (c,).
        part: of the residuals, its components those of the null and, last, what wanders.
    """

    index: int
    time_s: FloatArray
    size: FloatArray
    part: Part


def _inverse_of(covariance: FloatArray) -> tuple[FloatArray, float]:
    """The inverse (c, c), for a sixth of what that of any matrix would take, and the logarithm of the determinant."""
    root = np.linalg.cholesky(covariance)
    upper: FloatArray = dpotri(root.T)[0]  # the other triangle stays 0
    inverse = upper + upper.T
    inverse.flat[:: len(root) + 1] *= 0.5
    return inverse, 2.0 * float(np.sum(np.log(root.diagonal())))
