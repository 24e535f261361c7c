"""What columns explain is foretold, stretch by stretch, by all other stretches."""

import numpy as np
import pytest

from compensator.lab.left_over.white_rows import OUTLYING, WhiteRows, _at_ends, _bounded
from compensator.lab.screening.whitening import Whitening
from tests.lab.screening.test_noise import ROWS, TRIALS, coloured, learnt

STRETCH = np.repeat(np.arange(5), (40, 40, 40, 40, 400))
COLUMN = np.random.default_rng(1).standard_normal((len(STRETCH), 1))


def rows(coefficients) -> WhiteRows:
    """White rows in which the column has so large a coefficient in each stretch."""
    noise = learnt(coloured(np.random.default_rng(2)))
    count = len(STRETCH)
    residual = np.asarray(coefficients)[STRETCH] * COLUMN[:, 0]
    return WhiteRows(noise, Whitening(()), STRETCH, np.empty((count, 0)), residual)


def test_what_is_in_all_stretches_is_foretold_but_for_the_best_one():
    coefficients, foretold = rows(np.ones(5)).foretold(COLUMN)
    assert coefficients == pytest.approx([1.0])
    assert foretold == pytest.approx(np.sum(COLUMN[STRETCH < 4] ** 2))


@pytest.mark.parametrize("where", [0, 4])
def test_what_is_in_one_stretch_alone_is_not(where):
    assert rows(np.arange(5) == where).foretold(COLUMN)[1] <= 0.0


def test_rows_at_the_ends_of_strokes_that_hold_more_count_for_less():
    random = np.random.default_rng(3)
    noise, residual = learnt(coloured(random)), random.standard_normal(TRIALS * ROWS)
    inside = np.arange(TRIALS * ROWS) % ROWS
    at_end = (inside == 0) | (inside == ROWS - 1)
    assert np.all(_at_ends(noise, np.where(at_end, 0.2, 1.0) * residual) > 0.85)
    found = _at_ends(noise, np.where(at_end, 5.0, 1.0) * residual)
    assert np.all(found[at_end] < 0.4)
    assert np.all(found[~at_end] > 0.8)


def test_no_row_holds_more_than_a_few_deviations_and_rows_that_are_all_large_keep_their_shape():
    random = np.random.default_rng(4)
    residual = random.standard_normal(400)
    residual[::50] = 9.0
    assert np.abs(_bounded(residual)).max() == pytest.approx(OUTLYING, rel=0.2)
    wide = random.uniform(-20.0, 20.0, 400)
    assert _bounded(wide) == pytest.approx(wide)
