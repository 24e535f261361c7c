import json
import re
from pathlib import Path

import numpy as np
import pytest

from bench.errors import ParameterError
from bench.evaluation.blind.items import FAMILIES, SINGLE, Item, draw_item, items_of
from bench.evaluation.blind.judge import judge
from bench.evaluation.blind.pool import ResultsError, run_items
from bench.evaluation.blind.recorded import worn
from bench.evaluation.blind.result import Result
from compensator.lab.recordings.recording import Recording


def _empty(item: Item) -> Result:
    return Result(item.key, item.family, (), (), (), None, (), None, 0.0, refusal="not asked")


def test_the_same_seed_draws_the_same_items_and_a_longer_run_begins_with_a_shorter() -> None:
    assert items_of(3, 4)[: len(items_of(3, 2))] == items_of(3, 2)
    assert items_of(3, 2) != items_of(4, 2)
    assert len({item.seed for item in items_of(3, 40)}) == len(items_of(3, 40))
    for item in items_of(3, 1):
        assert draw_item(item, 0) == draw_item(item, 0)
        assert len(draw_item(item, 0).hidden) == FAMILIES[item.family].count


def test_some_families_alone_are_asked_the_same_as_among_all() -> None:
    wanted = [item for item in items_of(3, 2) if item.family in ("complete", "pair")]
    assert items_of(3, 2, ("complete", "pair")) == wanted
    with pytest.raises(ParameterError, match="known are complete"):
        items_of(3, 2, ("simple",))


def test_every_mechanism_of_a_family_comes_equally_often() -> None:
    plants = len(SINGLE) // FAMILIES["single"].per_plant + 1
    hidden = [draw_item(item, 0).hidden[0].name for item in items_of(1, plants) if item.family == "single"]
    assert set(hidden) == set(SINGLE)


def test_a_run_that_was_ended_goes_on_and_gives_the_same(tmp_path: Path) -> None:
    asked: list[str] = []

    def counted(item: Item) -> Result:
        asked.append(item.key)
        return _empty(item)

    items, kept, shown = items_of(1, 1), tmp_path / "deep" / "kept.jsonl", []
    first = run_items(items[:4], kept, lambda *done: shown.append(done), workers=0, ask=counted)
    again = run_items(items, kept, lambda *done: shown.append(done), workers=0, ask=counted)
    assert asked == [item.key for item in items]
    assert again[:4] == first
    assert shown[-1] == (len(items), len(items))
    assert len(kept.read_text().splitlines()) == len(items)


@pytest.mark.parametrize("content", ["{", "{}", "[1, 2]"])
def test_a_file_of_something_else_is_refused_and_left_alone(tmp_path: Path, content: str) -> None:
    kept = tmp_path / "kept.jsonl"
    kept.write_text(content)
    with pytest.raises(ResultsError, match="something else"):
        run_items(items_of(1, 1), kept, lambda *_: None, workers=0)
    assert kept.read_text() == content


def test_worn_recordings_lose_rows_and_regularity_but_no_order() -> None:
    time_s = 0.01 * np.arange(2000)
    recording = Recording("a", "excitation", {}, {"time_s": time_s, "duty": np.sin(time_s)})
    [found] = worn([recording], np.random.default_rng(1))
    steps = np.diff(found.channels["time_s"])
    assert 0.97 * 2000 < len(found) < 2000
    assert steps.min() > 0.0
    assert np.std(steps) > 0.02 * 0.01
    assert set(found.channels["duty"]) < set(recording.channels["duty"])


def _item(key: str) -> Item:
    seed, plant, *_ = map(int, re.findall(r"\d+", key))
    return next(item for item in items_of(seed, plant + 1) if item.key == key)


# a fixed part of the benchmark: recorded and diagnosed as all of it is
@pytest.mark.timeout(400)
def test_nothing_is_missing_of_a_complete_joint() -> None:
    found = judge(_item("101-0-complete-0"))
    assert found.answer is not None
    assert found.answer.verdict == "nothing"


@pytest.mark.timeout(400)
def test_an_effect_that_stands_out_is_named_and_the_result_can_be_kept() -> None:
    found = judge(_item("2001-6-single-2"))
    assert found.truths == ("cogging",)
    assert found.standings[0] is not None
    assert found.standings[0].detectability > 6.0
    assert found.answer is not None
    assert found.answer.first == found.names
    assert Result.from_json(json.loads(json.dumps(found.to_json()))) == found


@pytest.mark.timeout(400)
@pytest.mark.parametrize(
    ("key", "mechanism"), [("12001-3-memory-0", "shaft"), ("12001-9-memory-0", "backlash")], ids=["shaft", "backlash"]
)
def test_what_the_far_side_does_is_named_and_its_shadow_in_steady_sliding_is_not(key: str, mechanism: str) -> None:
    found = judge(_item(key))
    assert found.truths == (mechanism,)
    assert found.answer is not None
    assert found.answer.first == found.names


@pytest.mark.timeout(400)
def test_what_a_formula_leaves_open_is_not_said_to_remain() -> None:
    found = judge(_item("90001-13-single-2"))
    assert found.truths == ("periodic_friction",)
    assert found.answer is not None
    assert found.answer.first == found.names
    assert not found.answer.unknown
