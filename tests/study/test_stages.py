"""Whoever waits for something that is computed from a study is told of its stages."""

from collections.abc import Callable

import pytest

from bench.study.changes import add_effect
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.diagnosis.search import search
from bench.study.ladder import ladder
from bench.study.models.stages import CHANGE, COMPARISON, DIAGNOSING, LOADED
from compensator.lab import progress
from compensator.lab.diagnosis.four_families import STAGES
from compensator.lab.diagnosis.search import stages_of
from tests.lab.synthetic import plans
from tests.study.conftest import imported


@pytest.fixture(scope="module")
def number(store) -> int:
    return create_study(store, "stages", [imported(store, plans(loads_kg=(0.0, 0.2), repeats=2))]).study_id


def told_by(function: Callable[[], object]) -> list[progress.Stage]:
    told: list[progress.Stage] = []
    with progress.followed(told.append):
        function()
    return told


def places(told: list[progress.Stage]) -> list[float]:
    return [one.done + one.part for one in told]


@pytest.mark.parametrize(
    ("function", "names"),
    [
        (compare, COMPARISON),
        (ladder, LOADED),
        (lambda store, number: add_effect(store, number, "spring"), CHANGE),
        (lambda store, number: search(store, number, most=1), (*LOADED, DIAGNOSING, *stages_of(1))),
    ],
)
def test_stages_are_told_in_order_and_all_have_ended(store, number, function, names):
    told = told_by(lambda: function(store, number))
    assert told[0].names == names
    assert told[-1].done == told[-1].of == len(names)
    assert places(told) == sorted(places(told))


def test_a_search_says_what_is_done_within_its_stages(store, number):
    model_id = ladder(store, number).rungs[0].model_id
    told = told_by(lambda: search(store, number, model_id, most=2))
    within = {(one.name, one.within) for one in told}
    assert any(name.startswith("Adding effect 1") and inner in STAGES for name, inner in within)
