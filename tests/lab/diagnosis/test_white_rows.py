"""What columns explain is foretold, stretch by stretch, by all other stretches."""

import numpy as np
import pytest

from compensator.lab.diagnosis.white_rows import WhiteRows
from compensator.lab.screening.whitening import Whitening
from tests.lab.screening.test_noise import coloured, learnt

STRETCH = np.repeat(np.arange(5), (40, 40, 40, 40, 400))
COLUMN = np.random.default_rng(1).standard_normal((len(STRETCH), 1))


def rows(coefficients) -> WhiteRows:
    """White rows in which the column has so large a coefficient in each stretch."""
    noise = learnt(coloured(np.random.default_rng(2)))
    count = len(STRETCH)
    residual = np.asarray(coefficients)[STRETCH] * COLUMN[:, 0]
    return WhiteRows(noise, Whitening(()), np.ones(count), STRETCH, np.empty((count, 0)), residual)


def test_what_is_in_all_stretches_is_foretold_but_for_the_best_one():
    coefficients, foretold = rows(np.ones(5)).foretold(COLUMN)
    assert coefficients == pytest.approx([1.0])
    assert foretold == pytest.approx(np.sum(COLUMN[STRETCH < 4] ** 2))


@pytest.mark.parametrize("where", [0, 4])
def test_what_is_in_one_stretch_alone_is_not(where):
    assert rows(np.arange(5) == where).foretold(COLUMN)[1] <= 0.0
