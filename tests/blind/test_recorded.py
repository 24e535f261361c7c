from dataclasses import replace

import numpy as np
import pytest

from bench.evaluation.blind import recorded
from bench.evaluation.blind.figures import ratio_of
from bench.evaluation.blind.items import FAMILIES, MODERATE, draw_item, items_of, wanted_ratio
from bench.evaluation.blind.recorded import NEAR, Recorded, Scale
from bench.evaluation.challenge.hidden_plant import DrawnPlant

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
    """Let a residual grow with a power of the size, as a model would leave it, without any recording.

    Noise and scatter leave 1, a quiet joint that hides nothing leaves 0.5.
    """

    def made(item: object, drawn: DrawnPlant, attempt: int) -> Recorded:
        return Recorded(drawn, [], attempt)

    def plain(item: object, drawn: DrawnPlant, attempt: int, *, quiet: bool) -> Recorded:
        return Recorded(replace(drawn, hidden=()), [], 1 if quiet else 0)

    def left(found: Recorded) -> float:
        if not found.drawn.hidden:
            return 0.5 if found.attempt else 1.0
        return float(np.hypot(0.5, 3.0 * found.drawn.hidden[0].size ** steepness))

    monkeypatch.setattr(recorded, "_recorded", made)
    monkeypatch.setattr(recorded, "_record", lambda *_item, **_quiet: [])
    monkeypatch.setattr(recorded, "_plain", plain)
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


@pytest.fixture(scope="module")
def measured() -> tuple[DrawnPlant, Scale]:
    """A joint, and what an r is measured by, recorded."""
    drawn = draw_item(HOSE, 0)
    return drawn, Scale.of(HOSE, drawn, 0)


def test_a_quiet_joint_leaves_less_than_one_that_scatters(measured: tuple[DrawnPlant, Scale]) -> None:
    _, scale = measured
    assert 0.0 < scale.quiet < 0.8 * scale.noisy


def test_what_hides_next_to_nothing_has_no_r_and_more_of_it_has_more(measured: tuple[DrawnPlant, Scale]) -> None:
    drawn, scale = measured
    # encoder and cut-off let what is left differ by some percent between recordings that hide nothing
    next_to_nothing = [scale.ratio(draw_item(HOSE, 0, size)) for size in (1e-5, 1e-4, 2e-4, 1e-3)]
    assert np.median(next_to_nothing) < MODERATE[0] / 2.0
    assert scale.ratio(draw_item(HOSE, 0, 0.5)) < scale.ratio(drawn)
