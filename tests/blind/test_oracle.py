import numpy as np
import pytest

from bench.blind.oracle import NEEDED, standing
from tests.blind.columns import ROWS, gathered, independent


@pytest.mark.parametrize("ratio", [0.05, 0.2, 1.0])
@pytest.mark.parametrize("correlation", [0.0, 0.8])
def test_ratio_and_detectability_are_those_of_the_definition(ratio: float, correlation: float) -> None:
    effect, other, noise = independent(1, 3)
    rival = correlation * effect + np.sqrt(1.0 - correlation**2) * other
    found = standing(gathered(ratio * effect + noise, {"effect": effect, "rival": rival}), "effect")
    assert found is not None
    assert found.ratio == pytest.approx(ratio, rel=1e-6)
    # white noise: every row counts, but for what the lag-one correlation of so many rows happens to be
    wanted = np.sqrt(ROWS * np.log1p(ratio**2) * (1.0 - correlation**2))
    assert found.detectability == pytest.approx(wanted, rel=4.0 / np.sqrt(ROWS))
    assert found.smallest == pytest.approx(np.sqrt(NEEDED / ROWS), rel=4.0 / np.sqrt(ROWS))
    assert found.rival == "rival"


def test_rows_that_repeat_each_other_count_less() -> None:
    effect, noise = independent(2, 2)
    slow = np.empty(ROWS)
    slow[0] = noise[0]
    for row in range(1, ROWS):
        slow[row] = 0.8 * slow[row - 1] + 0.6 * noise[row]
    white, red = (standing(gathered(0.5 * effect + one, {"effect": effect}), "effect") for one in (noise, slow))
    assert white is not None
    assert red is not None
    # AR(1): (1 + 0.8) / (1 - 0.8) = 9 rows make one
    assert red.smallest / white.smallest == pytest.approx(3.0, rel=0.15)


def test_an_effect_that_is_no_candidate_has_no_standing() -> None:
    assert standing(gathered(independent(3, 1)[0], {}), "effect") is None
