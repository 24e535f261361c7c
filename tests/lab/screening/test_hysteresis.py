"""The free hysteresis gives way at shares of the travel, not at so many radians."""

import numpy as np

from compensator.lab.screening.generic import SHARES, hysteresis_columns
from tests.lab.left_over.judged import fitted


def test_from_what_slides_most_of_the_way_to_what_hardly_does():
    dataset = fitted().dataset
    columns = hysteresis_columns(dataset)
    assert columns.shape == (len(dataset.effort), len(SHARES))
    sliding = np.mean(np.abs(columns) > 0.99 * dataset.constant[:, None], axis=0)
    assert sliding[0] > 0.5
    assert 0.2 < sliding[1] < 0.4
    assert sliding[2] < 0.1
