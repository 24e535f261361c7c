"""What cosine and sine explain is what least squares makes of the two, beside the model."""

import numpy as np
import pytest

from compensator.lab.left_over.waves import Waves
from compensator.lab.model.linear import orthonormal

ROWS, PAIRS = 90, 6


def test_it_is_the_fall_of_the_squares():
    random = np.random.default_rng(1)
    basis = orthonormal(random.standard_normal((ROWS, 4)))
    columns = random.standard_normal((ROWS, 2 * PAIRS)) + basis[:, :1]
    residual = random.standard_normal(ROWS)
    residual -= basis @ (basis.T @ residual)
    found = Waves.of(columns, basis, residual)
    for index in range(PAIRS):
        pair = np.column_stack([basis, columns[:, [index, PAIRS + index]]])
        left = residual - pair @ np.linalg.lstsq(pair, residual, rcond=None)[0]
        assert found.size[index] == pytest.approx(residual @ residual - left @ left)
    beside = columns - basis @ (basis.T @ columns)
    assert found.left.ravel() == pytest.approx(np.sum(beside**2, axis=0))
    assert found.whole.ravel() == pytest.approx(np.sum(columns**2, axis=0))


def test_two_that_are_one_beside_the_model_explain_nothing():
    random = np.random.default_rng(2)
    basis = orthonormal(random.standard_normal((ROWS, 2)))
    cosine = random.standard_normal(ROWS)
    found = Waves.of(np.column_stack([cosine, 2.0 * cosine + basis[:, 0]]), basis, random.standard_normal(ROWS))
    assert found.size == pytest.approx([0.0])


def test_what_is_not_told_from_the_model_counts_for_nothing():
    waves = Waves(np.array([3.0, 4.0]), np.ones((2, 2)), np.ones((2, 2)))
    assert waves.where(np.array([True, False])) == pytest.approx([3.0, 0.0])
