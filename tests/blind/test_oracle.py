import numpy as np
import pytest

from bench.evaluation.blind import judge
from bench.evaluation.blind.figures import MUST_NAME
from bench.evaluation.blind.oracle import NEEDED, standing, standing_at_breakaway
from bench.evaluation.blind.result import Standing
from compensator.lab.screening.gathering import gather
from tests.blind.columns import ROWS, gathered, independent
from tests.lab.ramps import STATIC, ramp_fit

NAME = "dwell_strengthening"


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


@pytest.mark.parametrize("seen", [False, True])
def test_an_effect_with_memory_stands_out_where_it_shows_most(monkeypatch: pytest.MonkeyPatch, seen: bool) -> None:
    fit = ramp_fit(lambda rest_s, _rate: STATIC * (1.0 + 0.4 * rest_s / (rest_s + 1.0)))
    at_breakaway = standing_at_breakaway(fit, NAME)
    assert at_breakaway is not None
    assert at_breakaway.detectability > MUST_NAME
    in_motion = Standing(0.3, at_breakaway.detectability + 1.0, "pre_sliding", 0.1) if seen else None
    monkeypatch.setattr(judge, "standing", lambda *_: in_motion)
    found = judge._oracle(fit, gather(fit), (NAME,))[0][0]
    assert found == (in_motion or at_breakaway)


def test_nothing_stands_out_at_breakaway_where_nothing_is_hidden_or_nothing_can_be_seen() -> None:
    constant = standing_at_breakaway(ramp_fit(), NAME)
    assert constant is not None
    assert constant.detectability < 3.0
    assert standing_at_breakaway(ramp_fit(dwells_s=(0.3, 3.0), rates=(0.1,)), NAME) is None  # too few starts
    assert standing_at_breakaway(ramp_fit(), "backlash") is None  # none of its share is there
