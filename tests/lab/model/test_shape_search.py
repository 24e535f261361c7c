"""Shapes by variable projection: linear coefficients eliminated within their bounds, shapes between a grid's values."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Parameter
from compensator.lab.model.shape_search import _Search, between
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, recordings


@pytest.fixture(scope="module")
def dataset():
    return make_dataset(recordings(seed=3)[:2], FACTS, Processing())


@pytest.mark.parametrize(
    ("low", "high", "found"),
    [(0.3, 3.0, 3.0), (0.0, np.inf, 5.0), (-np.inf, np.inf, 5.0), (-np.inf, 0.0, 0.0), (6.0, 7.0, 6.0)],
)
def test_a_coefficient_beyond_its_bounds_explains_what_the_bound_does(dataset, low, high, found):
    rows = np.ones(len(dataset.target), dtype=bool)
    effect = replace(effect_named("viscous"), parameters=(Parameter("c", "", low, high),))
    search = _Search(dataset, effect, rows, np.empty((len(rows), 0)), np.ones(len(rows)))
    columns = dataset.target[:, None] / 5.0  # as if the effort were five of them
    left = dataset.target - found * columns[:, 0]
    explained = float(dataset.target @ dataset.target - left @ left)
    assert search.explained(columns) == pytest.approx(explained, rel=1e-9, abs=1e-9)


def test_a_search_stays_where_a_shape_is_its_effect(dataset):
    rows = np.ones(len(dataset.target), dtype=bool)
    free = effect_named("stribeck")
    speeds: list[float] = []
    for searched in (free.searched, lambda shape: shape[0] < 0.8 * speeds[0]):
        search = _Search(dataset, replace(free, searched=searched), rows, np.empty((len(rows), 0)), np.ones(len(rows)))
        speeds.append(search.refine(search.scan())[0])
    assert 0.75 * speeds[0] < speeds[1] < 0.8 * speeds[0]  # beyond the last value of the grid that is searched


def test_a_value_that_the_whole_grid_shares_costs_no_evaluations():
    def loss(shape):
        asked.append(shape)
        return np.log(shape[0] / 2.7) ** 2 + np.log(shape[1] / 0.15) ** 2

    asked, found = [], []
    for more in ((), (1.0,)):
        grid = [(a, b, *more) for a in (1.0, 2.0, 4.0) for b in (0.1, 0.2, 0.4)]
        found.append(between(grid, (2.0, 0.1, *more), loss))
    assert found[1] == (*found[0], 1.0)
    assert [shape[:2] for shape in asked[len(asked) // 2 :]] == asked[: len(asked) // 2]
    assert between([(2.0,)], (2.0,), loss) == (2.0,)


def test_a_shape_is_found_between_a_grid_s_values_and_not_beyond_them():
    grid = [(hz, damping) for hz in (1.0, 2.0, 4.0) for damping in (0.1, 0.4)]
    near = between(grid, (2.0, 0.1), lambda shape: np.log(shape[0] / 2.7) ** 2 + np.log(shape[1] / 0.15) ** 2)
    assert near == pytest.approx((2.7, 0.15), rel=0.03)
    assert between(grid, (4.0, 0.1), lambda shape: -shape[0] - shape[1]) == pytest.approx((4.0, 0.4), rel=1e-9)
