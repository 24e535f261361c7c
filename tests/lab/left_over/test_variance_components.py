"""Variances of components come out as large as they were made, whatever the base has of them."""

import numpy as np
import pytest
from scipy.stats import binom, chi2

from compensator.lab.left_over.variance_components import Part, likeliest, likelihood


def parts(variances, count=40, size=12, seed=2):
    """Residuals of white noise, of one that is alike along the rows, and of what the base has."""
    random = np.random.default_rng(seed)
    apart = np.abs(np.subtract.outer(np.arange(size), np.arange(size)))
    kernels = np.array([np.eye(size), np.exp(-apart / 6.0)])
    root = np.linalg.cholesky(np.tensordot(np.asarray(variances), kernels, 1))
    base = [np.column_stack([np.ones(size), random.standard_normal(size)]) for _ in range(count)]
    return [Part(own, root @ random.standard_normal(size) + own @ [0.3, -0.2], kernels) for own in base]


def test_variances_are_those_that_were_made():
    found = likeliest(parts([0.5, 0.2], count=400))
    assert found.variances == pytest.approx([0.5, 0.2], rel=0.2)


def test_a_component_that_is_not_there_gains_next_to_nothing():
    made = parts([0.5, 0.0])
    alone = likeliest([part.without_last for part in made])
    assert likeliest(made, alone.shares).likelihood.value - alone.likelihood.value < 2.0


@pytest.mark.parametrize("seed", range(8))
def test_a_score_that_is_not_above_zero_leaves_nothing_to_gain(seed):
    made = parts([0.5, 0.0], count=12, seed=seed)
    alone = likeliest([part.without_last for part in made])
    score = likelihood(np.append(alone.variances, 0.0), made).gradient[-1]
    gained = likeliest(made, alone.shares).likelihood.value - alone.likelihood.value
    assert (gained > 1e-3) == (score > 0.0)


def test_where_it_starts_does_not_matter():
    made = parts([0.5, 0.2])
    near = likeliest(made, np.array([0.9, 0.001]))
    assert near.variances == pytest.approx(likeliest(made).variances, rel=0.01)


def test_noise_gains_no_more_than_half_a_chi_squared_of_one_degree_of_freedom():
    gains = []
    for seed in range(60):
        made = parts([0.5, 0.0], count=12, seed=seed)
        alone = likeliest([part.without_last for part in made])
        gains.append(2.0 * (likeliest(made, alone.shares).likelihood.value - alone.likelihood.value))
    chances = np.where(np.array(gains) > 0.0, 0.5 * chi2.sf(np.maximum(gains, 0.0), 1), 1.0)
    few, many = binom.ppf([1e-3, 1.0 - 1e-3], len(chances), 0.1)
    assert few <= np.sum(chances <= 0.1) <= many


def test_what_the_base_explains_speaks_for_no_component():
    made = parts([0.5, 0.2])
    more = [Part(part.base, part.residual + part.base @ [100.0, 50.0], part.kernels) for part in made]
    assert likelihood(np.array([0.4, 0.3]), more).value == pytest.approx(likelihood(np.array([0.4, 0.3]), made).value)


def test_the_gradient_of_the_likelihood_is_its_slope():
    random = np.random.default_rng(2)
    root = random.standard_normal((2, 9, 9))
    kernels = np.array([np.eye(9), *(one @ one.T for one in root)])
    made = [Part(random.standard_normal((9, 2)), random.standard_normal(9), kernels)]
    at, step = np.array([0.7, 0.2, 0.4]), 1e-6
    found = likelihood(at, made)
    for index in range(3):
        beyond = at + step * np.eye(3)[index]
        slope = (likelihood(beyond, made).value - found.value) / step
        assert found.gradient[index] == pytest.approx(slope, rel=1e-3, abs=1e-4)
