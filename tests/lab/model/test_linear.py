"""Bounded least squares against scipy, dependent columns, normal equations."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from compensator.lab.model.linear import Bounds, independent, orthonormal, solve, solve_normal, solve_without


def free(count: int) -> Bounds:
    return Bounds(np.full(count, -np.inf), np.full(count, np.inf))


@pytest.fixture
def problem():
    random = np.random.default_rng(4)
    columns = random.standard_normal((200, 4)) * np.array([1.0, 1e-4, 1e3, 5.0])
    return columns, columns @ np.array([2.0, -3e3, 1e-3, 0.4]) + 0.01 * random.standard_normal(200)


def test_free_solution_is_ordinary_least_squares(problem):
    columns, effort = problem
    found = solve(columns, effort, free(4))
    assert found.coefficients == pytest.approx(np.linalg.lstsq(columns, effort, rcond=None)[0], rel=1e-8)
    assert found.kept.all()
    assert not found.at_bound.any()


def test_bounds_give_what_scipy_gives(problem):
    columns, effort = problem
    scaled = columns / np.linalg.norm(columns, axis=0)  # scipy is asked in its own comfort zone
    bounds = Bounds(np.array([-np.inf, 0.0, 0.0, 0.5]), np.array([1.5, np.inf, np.inf, 0.6]))
    norm = np.linalg.norm(columns, axis=0)
    wanted = lsq_linear(scaled, effort, (bounds.low * norm, bounds.high * norm), method="bvls", tol=1e-14).x / norm
    found = solve(columns, effort, bounds)
    assert found.coefficients == pytest.approx(wanted, rel=1e-6, abs=1e-9)
    assert found.at_bound.tolist() == [True, True, False, True]


def test_of_dependent_columns_the_later_is_dropped():
    random = np.random.default_rng(5)
    a, b = random.standard_normal((2, 100))
    columns = np.column_stack([a, b, 2.0 * a - b, np.zeros(100), a + 1e-6 * random.standard_normal(100)])
    assert independent(columns).tolist() == [True, True, False, False, False]
    found = solve(columns, 3.0 * a + b, free(5))
    assert found.coefficients == pytest.approx([3.0, 1.0, 0.0, 0.0, 0.0])
    assert not found.at_bound.any()


def test_of_dependent_columns_one_that_its_bound_holds_gives_way():
    """Of a shaft that only slows down: what its friction brakes, its inertia would have to push."""
    random = np.random.default_rng(8)
    speed, other = random.standard_normal((2, 100))
    columns = np.column_stack([-0.5 * speed, other, speed])
    bounds = Bounds(np.zeros(3), np.full(3, np.inf))
    found = solve(columns, 3.0 * speed + other, bounds)
    assert found.coefficients == pytest.approx([0.0, 1.0, 3.0])
    assert found.kept.tolist() == [False, True, True]
    assert not found.at_bound.any()
    pushed = solve(columns, other - 3.0 * speed, bounds)
    assert pushed.coefficients == pytest.approx([6.0, 1.0, 0.0])


def test_nearly_dependent_columns_are_kept_down_to_the_limit():
    random = np.random.default_rng(6)
    a, b = np.linalg.qr(random.standard_normal((100, 2)))[0].T
    assert independent(np.column_stack([a, a + 3e-4 * b])).tolist() == [True, True]
    assert independent(np.column_stack([a, a + 3e-5 * b])).tolist() == [True, False]


def test_orthonormal_spans_the_columns():
    random = np.random.default_rng(7)
    columns = random.standard_normal((50, 3))
    basis = orthonormal(np.column_stack([columns, columns.sum(axis=1)]))
    assert basis.T @ basis == pytest.approx(np.eye(3))
    assert basis @ (basis.T @ columns) == pytest.approx(columns)
    assert orthonormal(np.zeros((50, 2))).shape == (50, 0)


def test_normal_equations_are_enough(problem):
    columns, effort = problem
    bounds = Bounds(np.zeros(4), np.full(4, np.inf))
    found = solve_normal(columns.T @ columns, columns.T @ effort, bounds)
    assert found == pytest.approx(solve(columns, effort, bounds).coefficients, rel=1e-9, abs=1e-12)


def test_normal_equations_of_a_left_out_direction_stay_finite():
    columns = np.column_stack([np.ones(20), np.ones(20)])
    found = solve_normal(columns.T @ columns, columns.T @ (4.0 * np.ones(20)), free(2))
    assert found.sum() == pytest.approx(4.0)
    assert np.isfinite(found).all()


def test_a_column_that_only_the_left_out_rows_excite_counts_nothing_without_them():
    random = np.random.default_rng(8)
    columns = random.standard_normal((300, 3))
    columns[100:, 2] = 0.0
    effort = columns @ np.array([1.0, 2.0, 3.0]) + 0.01 * random.standard_normal(300)
    whole = columns.T @ columns, columns.T @ effort
    whole[0][2, 2] += 1e-13  # what another order of the same sums would leave
    part = columns[:100].T @ columns[:100], columns[:100].T @ effort[:100]
    found = solve_without(whole, part, free(3))
    assert found[:2] == pytest.approx(np.linalg.lstsq(columns[100:, :2], effort[100:], rcond=None)[0], rel=1e-6)
    assert found[2] == 0.0
