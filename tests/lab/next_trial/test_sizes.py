"""Sizes that trials allow an effect, and what can be promised of it."""

import numpy as np
import pytest

from compensator.lab.next_trial.sizes import chance_of, possible_sizes, promised

FREE = (-np.inf, np.inf)


def sizes(mean, deviation, bounds=FREE):
    return possible_sizes(np.array([mean]), np.array([[deviation**2]]), [bounds], 400)


def test_without_bounds_sizes_scatter_about_the_estimate_by_its_error():
    found = sizes(3.0, 0.5)
    assert found.shape == (400, 1)
    assert found.mean() == pytest.approx(3.0)
    assert found.std() == pytest.approx(0.5, rel=0.01)


def test_an_estimate_beyond_its_bound_leaves_small_sizes_within_it():
    found = sizes(-0.2, 0.1, (0.0, np.inf))
    assert found.min() >= 0.0
    assert found.mean() == pytest.approx(0.0373, rel=0.02)  # of a normal distribution cut at two deviations
    assert np.all(sizes(-0.2, 0.001, (0.0, np.inf)) < 1e-4)
    assert np.all(sizes(2.0, 0.0, (0.0, 1.0)) == 1.0)


def test_two_coefficients_scatter_together():
    covariance = np.array([[1.0, 0.8], [0.8, 1.0]])
    mean = np.array([1.0, -2.0])
    found = possible_sizes(mean, covariance, [FREE, FREE], 512)
    np.testing.assert_allclose(found.mean(axis=0), mean, atol=1e-9)
    np.testing.assert_allclose(np.cov(found.T), covariance, atol=0.1)
    assert possible_sizes(mean, covariance, [FREE, (-1.0, 1.0)], 64)[:, 1].min() == -1.0


def test_what_nine_in_ten_reach_is_promised_and_nothing_of_an_effect_that_may_be_none():
    evidence, known = np.arange(1001.0), 10**9
    assert promised(evidence, 1.0, known) == pytest.approx(100.0, rel=1e-3)
    # of five in a hundred there is none already
    assert promised(evidence, 0.95, known) == pytest.approx(1000.0 * 0.05 / 0.95, rel=0.02)
    assert promised(evidence, 0.89, known) == 0.0
    assert chance_of(0.0) == 0.5
    assert chance_of(2.0 * np.log(9.0)) == pytest.approx(0.9)


def test_less_is_promised_where_few_stretches_tell_the_noise():
    few, many = (promised(np.full(8, 100.0), 1.0, stretches) for stretches in (10, 100))
    assert few == pytest.approx(10.0 * 4.865, rel=0.03)  # a tenth of chi-squared of 10 lies below
    assert 75.0 < many < 85.0
