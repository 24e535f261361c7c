"""Scatter between stretches, on rows whose scatter is known."""

import numpy as np
import pytest

from compensator.lab.next_trial.rivalry import rows_per_independent_row

ROWS = 40  # of a stretch


def _typical(powers: list[float], scatter: float) -> tuple[float, float]:
    """Median of what is found over many joints, and the truth.

    Args:
        powers: of the effect in each stretch.
        scatter: of the effect's size between stretches, over what the white noise of a row makes of it.
    """
    random = np.random.default_rng(3)
    stretch = np.repeat(np.arange(len(powers)), ROWS)
    found = []
    own = random.normal(size=len(stretch)) * np.sqrt(np.array(powers) / ROWS)[stretch]
    by_stretch = np.bincount(stretch, weights=own**2)
    for _ in range(400):
        noise = random.normal(size=len(stretch)) + scatter * random.normal(size=len(powers))[stretch] * own
        left = noise - own * float(own @ noise) / float(own @ own)
        found.append(rows_per_independent_row(own, left, stretch))
    return float(np.median(found)), 1.0 + scatter**2 * float(np.sum(by_stretch**2) / np.sum(by_stretch))


@pytest.mark.parametrize("scatter", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("powers", [[1.0] * 8, [5.0, 1, 1, 1, 1, 1], [4.0, 4, 0.1, 0.1, 0.1, 0.1]])
def test_scatter_between_stretches_is_found_however_unevenly_they_hold_the_effect(
    powers: list[float], scatter: float
) -> None:
    found, true = _typical(powers, scatter)
    assert 0.5 < found / true < 1.5  # the median of what scatters like chi-squared of so few stretches


def test_an_effect_that_adds_nothing_is_judged_by_its_rows() -> None:
    assert rows_per_independent_row(np.zeros(6), np.ones(6), np.arange(6)) == 1.0


def test_an_effect_of_one_stretch_alone_has_no_scatter_between_stretches() -> None:
    own = np.r_[np.ones(6), np.zeros(6)]
    left = np.r_[1.0, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1]
    assert rows_per_independent_row(own, left, np.repeat([0, 1], 6)) == pytest.approx(0.0)
