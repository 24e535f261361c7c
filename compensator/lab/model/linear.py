"""Bounded least squares that says which columns the data cannot tell apart, instead of dividing by nearly nothing."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from compensator.lab.effects.effect import Effect, Shape
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray

DEPENDENT = 1e-4  # share of a column's norm left after projection below which it is no new direction


@dataclass(frozen=True)
class Bounds:
    """Lowest and highest allowed coefficient of each column, shape (k,); infinite where there is none."""

    low: FloatArray
    high: FloatArray

    def of(self, chosen: BoolArray) -> "Bounds":
        """The bounds of some columns."""
        return Bounds(self.low[chosen], self.high[chosen])


@dataclass(frozen=True)
class Solution:
    """Result of a least-squares fit.

    Attributes:
        coefficients: shape (k,); 0 where not kept.
        kept: columns that are independent of those before them, shape (k,).
        at_bound: coefficients that a bound holds, shape (k,).
    """

    coefficients: FloatArray
    kept: BoolArray
    at_bound: BoolArray


@dataclass(frozen=True)
class Term:
    """One fitted effect.

    Attributes:
        effect: which.
        shape: its nonlinear shape values.
        coefficients: one per parameter of the effect, shape (k,).
        kept: which of them the data determine.
        at_bound: which of them a physical bound holds.
    """

    effect: Effect
    shape: Shape
    coefficients: FloatArray
    kept: BoolArray
    at_bound: BoolArray


def independent(columns: FloatArray) -> BoolArray:
    """Which columns of (N, k) are not combinations of those before them."""
    return _gram_schmidt(np.asfortranarray(columns))[0]  # in memory as they are gone through


def orthonormal(columns: FloatArray) -> FloatArray:
    """Orthonormal basis of the span of (N, k); shape (N, rank)."""
    return _gram_schmidt(columns)[1]


def _gram_schmidt(columns: FloatArray) -> tuple[BoolArray, FloatArray]:
    """Which columns of (N, k) say something new, and an orthonormal basis (N, rank) of them, in their order."""
    kept = np.zeros(columns.shape[1], dtype=bool)
    whole, rank = np.empty(columns.shape, order="F"), 0
    for index, column in enumerate(columns.T):
        norm = math.sqrt(column @ column)
        basis = whole[:, :rank]
        rest = column - basis @ (basis.T @ column)
        rest -= basis @ (basis.T @ rest)  # twice is enough (Kahan, Parlett)
        left = math.sqrt(rest @ rest)
        if norm > 0.0 and left > DEPENDENT * norm:
            kept[index] = True
            whole[:, rank] = rest / left
            rank += 1
    return kept, whole[:, :rank]


def solve(columns: FloatArray, effort: FloatArray, bounds: Bounds) -> Solution:
    """Bounded least squares of effort (N,) on columns (N, k), dropping dependent columns in order.

    A column that only its bound holds gives way to one that was dropped for it, where that explains more: of a shaft
    that only slows down, acceleration, speed and friction say the same, and not every one of them has the right sign.
    """
    found = _solve(columns, effort, bounds, np.arange(columns.shape[1]))
    if found.kept.all() or not found.at_bound.any():
        return found
    other = _solve(columns, effort, bounds, np.argsort(found.at_bound, kind="stable"))
    left, other_left = (float(np.linalg.norm(effort - columns @ one.coefficients)) for one in (found, other))
    return other if other_left < (1.0 - DEPENDENT) * left else found


def _solve(columns: FloatArray, effort: FloatArray, bounds: Bounds, order: IntArray) -> Solution:
    """Bounded least squares, dropping columns that depend on those before them in an order (k,)."""
    kept = np.zeros(len(order), dtype=bool)
    kept[order] = independent(columns[:, order])
    coefficients = np.zeros(len(order))
    if kept.any():
        used = columns[:, kept]
        coefficients[kept] = solve_normal(used.T @ used, used.T @ effort, bounds.of(kept))
    at_bound = kept & ((coefficients <= bounds.low) | (coefficients >= bounds.high))
    return Solution(coefficients, kept, at_bound)


def solve_normal(gram: FloatArray, moment: FloatArray, bounds: Bounds) -> FloatArray:
    """Coefficients from normal equations gram (k, k), moment (k,), within bounds (Stark, Parker 1995: BVLS)."""
    scale = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(gram / np.outer(scale, scale))
    solid = values > 1e-12 * values[-1]
    axes, size = vectors[:, solid], np.sqrt(values[solid])
    wanted = (axes.T @ (moment / scale)) / size
    free: FloatArray = (axes @ (wanted / size)) / scale  # of all that fit as well, the least
    if np.all(free >= bounds.low) and np.all(free <= bounds.high):
        return free
    root = axes * size  # gram = root root'
    found = lsq_linear(root.T, wanted, (bounds.low * scale, bounds.high * scale), method="bvls")
    bounded: FloatArray = np.clip(found.x / scale, bounds.low, bounds.high)
    return bounded


def solve_without(
    whole: tuple[FloatArray, FloatArray], part: tuple[FloatArray, FloatArray], bounds: Bounds
) -> FloatArray:
    """Coefficients from normal equations (gram, moment) once a part of the rows is taken out of them.

    A column that only these rows excite is undetermined without them, and gets the coefficient nearest to 0: what
    rounding leaves of its power would give it any other.
    """
    gram, moment = whole[0] - part[0], whole[1] - part[1]
    left = np.diag(gram) > DEPENDENT**2 * np.diag(whole[0])
    coefficients = np.clip(np.zeros(len(moment)), bounds.low, bounds.high)
    if left.any():
        coefficients[left] = solve_normal(gram[np.ix_(left, left)], moment[left], bounds.of(left))
    return coefficients
