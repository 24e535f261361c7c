from dataclasses import replace

import numpy as np
import pytest

from bench.blind import recorded
from bench.blind.items import FAMILIES, MODERATE, draw_item, items_of, wanted_ratio
from bench.blind.recorded import NEAR, Recorded, ratio_of

HOSE = next(item for item in items_of(3, 2) if item.family == "outside-moderate" and item.turn == 1)


def test_scaling_changes_how_much_is_hidden_and_nothing_else() -> None:
    once, twice = draw_item(HOSE, 0), draw_item(HOSE, 0, 2.0)
    assert once.joint == twice.joint
    assert twice.hidden[0].size == pytest.approx(2.0 * once.hidden[0].size)
    [table, doubled] = [one.hidden[0].tables["hose"] for one in (once, twice)]
    assert doubled["reach_rad"] == table["reach_rad"]
    assert doubled["stiffness_n_m_rad"] == pytest.approx(2.0 * table["stiffness_n_m_rad"])


def test_an_r_is_wanted_only_where_the_family_asks_for_one_and_all_of_its_range_is_drawn() -> None:
    for item in items_of(3, 1):
        assert (wanted_ratio(item, 0) is None) == (FAMILIES[item.family].ratios is None)
    low, high = MODERATE
    wanted = np.array([wanted_ratio(item, 0) for item in items_of(3, 200, ["outside-moderate"])], dtype=float)
    assert wanted.min() >= low
    assert wanted.max() <= high
    assert 0.4 < float(np.mean(wanted < np.sqrt(low * high))) < 0.6


def _left_by(monkeypatch: pytest.MonkeyPatch, steepness: float) -> None:
    """Let a residual grow with a power of the size, as a model would leave it, without any recording."""

    def made(item: object, attempt: int, scale: float) -> Recorded:
        return Recorded(draw_item(HOSE, attempt, scale), [], attempt)

    def left(found: Recorded) -> float:
        return float(np.sqrt(1.0 + (3.0 * found.drawn.hidden[0].size ** steepness) ** 2)) if found.drawn.hidden else 1.0

    monkeypatch.setattr(recorded, "_recorded", made)
    monkeypatch.setattr(recorded, "_plain", lambda item, found: replace(found, drawn=replace(found.drawn, hidden=())))
    monkeypatch.setattr(recorded, "_left", left)


@pytest.mark.parametrize("steepness", [0.7, 1.0, 3.0])
@pytest.mark.parametrize("wanted", [0.3, 1.0])
def test_sizes_are_scaled_until_the_wanted_r_is_there(
    monkeypatch: pytest.MonkeyPatch, steepness: float, wanted: float
) -> None:
    _left_by(monkeypatch, steepness)
    monkeypatch.setattr(recorded, "wanted_ratio", lambda item, attempt: wanted)
    found = recorded.recorded(HOSE)
    ratio = 3.0 * found.drawn.hidden[0].size ** steepness
    assert 1.0 / NEAR <= ratio / wanted <= NEAR


def test_no_size_goes_beyond_its_range(monkeypatch: pytest.MonkeyPatch) -> None:
    _left_by(monkeypatch, 1.0)
    monkeypatch.setattr(recorded, "wanted_ratio", lambda item, attempt: 1e3)
    assert recorded.recorded(HOSE).drawn.hidden[0].size == pytest.approx(1.5)


def test_the_r_of_what_no_effect_stands_for() -> None:
    assert ratio_of(np.sqrt(2.0)) == pytest.approx(1.0)
    assert ratio_of(0.9) == 0.0
