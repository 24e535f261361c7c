"""Whether dry friction jumps between two values, and back, at moments that nothing announces.

What wanders (`wandering.py`) is told by its variance. What jumps says more: it has two values, the same in all trials,
and goes from one to the other at once. So a process of two hidden states (a random telegraph) stands beside the same
components, and its likelihood is summed over all courses of up to two jumps in a trial, between any two cells:

L = prod over trials of sum over courses x of p(x) N(r - B b - h x; K(v))

Height h, the base's coefficients b, and the variances v of what scatters are found by expectation and maximisation
(Dempster, Laird, Rubin 1977). Twice the logarithm of the likelihood gained is, in noise alone, zero in half of all
cases, since both values are as good as one there, and chi-squared of one degree of freedom in the others.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.variance_components import CellsOfTrial, likeliest_of_moments
from compensator.lab.recordings.recording import FloatArray

MEAN_S = 4.0  # between jumps: some seconds
MOST_MOMENTS = 55  # of a trial, at which it may jump: twice of so many makes some thousand courses
ROUNDS = 12  # of new variances
STEPS = 5  # of the rest, between them
CONVERGED = 0.05  # of twice the logarithm of the likelihood
TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Jumps:
    """Two values that dry friction jumps between.

    Attributes:
        gained: twice the logarithm of the likelihood, over that of a model without jumps.
        height: between the values, in units of what wanders.
        courses: likeliest of every trial, in the same unit, each of shape (c,).
    """

    gained: float
    height: float
    courses: list[FloatArray]


@dataclass(frozen=True)
class _Courses:
    """Of a trial.

    Attributes:
        values: of each cell in each course, -1/2 or 1/2 of its size; shape (c, m).
        likely: logarithm of their chances, shape (m,).
    """

    values: FloatArray
    likely: FloatArray


@dataclass(frozen=True)
class _Model:
    """What is not known: variances of what scatters (k,), coefficients of the base (b,), height of the jumps."""

    variances: FloatArray
    coefficients: FloatArray
    height: float


@dataclass(frozen=True)
class _Expected:
    """What the residuals make of a model.

    Attributes:
        likelihood: its logarithm.
        means: of each trial's course, shape (c,).
        chances: of each of its courses or its mirror image, shape (m,).
        height: that would be likelier.
    """

    likelihood: float
    means: list[FloatArray]
    chances: list[FloatArray]
    height: float


@dataclass(frozen=True)
class _Weighed:
    """What variances alone make of a trial: the same in all steps between new ones.

    Attributes:
        precision: of the cells, shape (c, c); volume: logarithm of its determinant's root.
        base: the precision by the base's columns, shape (c, b); courses: by those of the courses, shape (c, m).
        sizes: of the courses, shape (m,).
    """

    precision: FloatArray
    volume: float
    base: FloatArray
    courses: FloatArray
    sizes: FloatArray


def jumps_of(trials: Sequence[CellsOfTrial], variances: FloatArray) -> Jumps:
    """How far dry friction jumps.

    Args:
        trials: their last component is left out.
        variances: of the others (k - 1,), likeliest where nothing jumps.
    """
    straight = [_Courses(np.zeros((len(one.time_s), 1)), np.zeros(1)) for one in trials]
    alone = _without(trials, straight, variances)
    plain = _expected(trials, straight, _weighed(trials, straight, alone.variances), alone)
    courses = [_courses(one) for one in trials]
    left = np.concatenate(_left(trials, alone.coefficients))
    size = np.concatenate([one.size for one in trials])
    model = _Model(alone.variances, alone.coefficients, float(np.sqrt(left @ left / max(size @ size, TINY))))
    gained, expected = -np.inf, plain
    for _ in range(ROUNDS):
        weighed = _weighed(trials, courses, model.variances)
        for _ in range(STEPS):
            expected = _expected(trials, courses, weighed, model)
            model = _likelier(trials, weighed, model, expected)
        before, gained = gained, 2.0 * (expected.likelihood - plain.likelihood)
        if gained - before < CONVERGED:
            break
        model = _Model(_scattering(trials, courses, model, expected), model.coefficients, model.height)
    found = [model.height * mean / one.size for mean, one in zip(expected.means, trials, strict=True)]
    return Jumps(gained, abs(model.height), found)


def _courses(trial: CellsOfTrial) -> _Courses:
    """Up to two jumps, MEAN_S apart on average, from one of the values on; those from the other mirror them."""
    order = np.argsort(trial.time_s, kind="stable")
    gaps_s = np.diff(trial.time_s[order])
    groups = [one for one in np.array_split(np.arange(len(gaps_s)), MOST_MOMENTS) if len(one)]
    at = np.array([one[np.argmax(gaps_s[one])] for one in groups], dtype=int)
    apart_s = np.maximum([gaps_s[one].sum() for one in groups], TINY)
    odds = np.log(np.tanh(apart_s / MEAN_S))  # of another state over the same one, so much later
    after = np.arange(len(gaps_s) + 1)[:, None] > at  # (c, jumps)
    first, second = np.triu_indices(len(at), 1)
    turned = np.column_stack([np.zeros((len(after), 1), bool), after, after[:, first] & ~after[:, second]])
    likely = np.concatenate([[0.0], odds, odds[first] + odds[second]])
    values = np.empty(turned.shape)
    values[order] = np.where(turned, -0.5, 0.5)
    return _Courses(values * trial.size[:, None], likely - np.log(np.sum(np.exp(likely))))


def _without(trials: Sequence[CellsOfTrial], straight: Sequence[_Courses], variances: FloatArray) -> _Model:
    """The likeliest model where nothing jumps, by courses that do not."""
    nothing = _Expected(0.0, [np.zeros(len(one.time_s)) for one in trials], [np.ones(1) for _ in trials], 0.0)
    model = _likelier(trials, _weighed(trials, straight, variances), _Model(variances, np.zeros(0), 0.0), nothing)
    for _ in range(2):
        scattering = _scattering(trials, straight, model, nothing)
        weighed = _weighed(trials, straight, scattering)
        model = _likelier(trials, weighed, _Model(scattering, model.coefficients, 0.0), nothing)
    return model


def _left(trials: Sequence[CellsOfTrial], coefficients: FloatArray) -> list[FloatArray]:
    """What a fit of the base leaves of each trial's residuals."""
    return [one.part.residual - one.part.base @ coefficients for one in trials]


def _weighed(trials: Sequence[CellsOfTrial], courses: Sequence[_Courses], variances: FloatArray) -> list[_Weighed]:
    """Each trial's base and courses by the precision that these variances have."""
    found = []
    for trial, own in zip(trials, courses, strict=True):
        root = np.linalg.cholesky(np.tensordot(variances, trial.part.kernels[:-1], 1))
        inverse = np.linalg.inv(root)
        precision, volume = inverse.T @ inverse, -float(np.sum(np.log(np.diag(root))))
        weighed = precision @ own.values
        sizes = np.einsum("cm,cm->m", own.values, weighed)
        found.append(_Weighed(precision, volume, precision @ trial.part.base, weighed, sizes))
    return found


def _expected(
    trials: Sequence[CellsOfTrial], courses: Sequence[_Courses], weighed: Sequence[_Weighed], model: _Model
) -> _Expected:
    """How likely each course is, by the residuals."""
    likelihood, along, power = 0.0, 0.0, 0.0
    means, all_chances = [], []
    for own, by, left in zip(courses, weighed, _left(trials, model.coefficients), strict=True):
        scores = left @ by.courses
        # a course and its mirror image
        both = model.height * np.array([scores, -scores]) - 0.5 * model.height**2 * by.sizes + own.likely
        most = float(both.max())
        chances = np.exp(both - most)
        sum_of = float(chances.sum())
        chances /= sum_of
        likelihood += by.volume + most + float(np.log(0.5 * sum_of)) - 0.5 * float(left @ by.precision @ left)
        way, any_way = chances[0] - chances[1], chances[0] + chances[1]
        means.append(own.values @ way)
        all_chances.append(any_way)
        along += float(scores @ way)
        power += float(by.sizes @ any_way)
    return _Expected(likelihood, means, all_chances, along / power if power > 0.0 else 0.0)


def _likelier(
    trials: Sequence[CellsOfTrial], weighed: Sequence[_Weighed], model: _Model, expected: _Expected
) -> _Model:
    """Coefficients by generalised least squares beside the expected courses, and the expected height."""
    normal = np.sum([by.base.T @ trial.part.base for by, trial in zip(weighed, trials, strict=True)], axis=0)
    left = [one.part.residual - expected.height * mean for one, mean in zip(trials, expected.means, strict=True)]
    moment = np.sum([by.base.T @ own for by, own in zip(weighed, left, strict=True)], axis=0)
    coefficients: FloatArray = np.linalg.pinv(normal, rcond=1e-10, hermitian=True) @ moment
    return _Model(model.variances, coefficients, expected.height)


def _scattering(
    trials: Sequence[CellsOfTrial], courses: Sequence[_Courses], model: _Model, expected: _Expected
) -> FloatArray:
    """Likelier variances of what scatters beside the expected courses."""
    moments, left = [], _left(trials, model.coefficients)
    for one, own, mean, chances in zip(left, courses, expected.means, expected.chances, strict=True):
        crossed = model.height * np.outer(one, mean)
        square = (own.values * chances) @ own.values.T
        moments.append(np.outer(one, one) - crossed - crossed.T + model.height**2 * square)
    return likeliest_of_moments(moments, [one.part.kernels[:-1] for one in trials], model.variances)
