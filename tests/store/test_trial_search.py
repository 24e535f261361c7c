"""A list of trials that a person looks through: words, order, pages."""

from datetime import UTC, date, datetime, timedelta

import pytest
from sqlalchemy import delete

from bench.store.errors import StoreValueError
from bench.store.schema import TRIAL_CONDITION
from bench.store.tables import experiments
from bench.store.tables.days import begin_and_end
from bench.store.tables.trial_search import TrialQuery
from tests.store.rates import fill

COUNT = 300


@pytest.fixture
def filled(store):
    fill(store, COUNT)
    return store


def names(found):
    return [trial.name for trial in found[0]]


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ((), lambda n: True),
        (("steps",), lambda n: n % 3 == 0),
        (("STEPS", "tripped"), lambda n: n % 3 == 0 and n % 97 == 0),
        (("nlgi", "sweep"), lambda n: n % 3 > 0),
        (("balanced", "load-sweep"), lambda n: n % 2 == 0 and n % 3 == 1),
        (("0.05",), lambda n: n % 11 == 5),
        (("load", "50"), lambda n: n % 11 == 5 or n == 49 or "50" in str(n)),  # grams, or a number
        (("100%",), lambda n: False),
        (("trial_",), lambda n: False),  # an underscore is no wildcard
        (("zzz",), lambda n: False),
    ],
)
def test_words_find_what_has_all_of_them_somewhere(filled, words, wanted):
    found, total = filled.search_trials(TrialQuery(words=words), limit=1000)
    expected = [f"trial {number}" for number in range(COUNT) if wanted(number)]
    assert [trial.name for trial in found] == expected
    assert total == len(expected)


def test_a_word_that_all_trials_have_restricts_nothing_and_one_that_all_but_one_have_does(filled):
    assert filled.search_trials(TrialQuery(words=("nlgi",)), limit=1)[1] == COUNT
    with filled._database.writing() as connection:
        wanted = (TRIAL_CONDITION.c.trial_id == 7) & (TRIAL_CONDITION.c.key == "grease")
        connection.execute(delete(TRIAL_CONDITION).where(wanted))
    found, total = filled.search_trials(TrialQuery(words=("nlgi",)), limit=COUNT)
    assert total == COUNT - 1
    assert 7 not in [trial.id for trial in found]


def test_words_are_found_among_more_keys_texts_and_kinds_than_a_statement_names(store):
    experiment = store.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
    conditions = [
        {f"c{number}": number for number in range(1100)},
        {f"t{number}": f"oil {number}" for number in range(1100)},
    ]
    conditions += [{"load_kg": 0.05}, {"heated": False}]
    for number in range(120):
        held = conditions[number] if number < len(conditions) else {}
        store.begin_trial(experiment, f"trial {number}", f"k{number}", held, ["time_s"]).finish("completed", "", {})

    def found(*words):
        return [int(name.split()[1]) for name in names(store.search_trials(TrialQuery(words=words), 200))]

    assert found("777.0") == found("c777") == [0]
    assert found("t777") == found("oil 777") == found("oil") == [1]
    assert found("0.5e2") == [0, 2, 49]  # the value, grams, the number of the trial
    assert found("heated") == []
    assert found("k11") == [11, *range(110, 120)]
    assert found("1", "2", "3", "4", "5", "6", "7", "8") == [0, 1]


def test_pages_are_cut_from_one_order(filled):
    query = TrialQuery(sort="kind", descending=True)
    whole = names(filled.search_trials(query, limit=COUNT))
    pages = [name for offset in range(0, COUNT, 70) for name in names(filled.search_trials(query, 70, offset))]
    assert pages == whole
    kinds = [trial.kind for trial in filled.search_trials(query, limit=COUNT)[0]]
    assert kinds == sorted(kinds, reverse=True)
    assert filled.search_trials(query, 10, COUNT)[1] == COUNT


def test_conditions_come_with_each_trial_and_filters_join_words(filled):
    query = TrialQuery(conditions={"load_kg": (0.02, 0.03)}, outcome="completed", words=("steps",))
    found, total = filled.search_trials(query, limit=5)
    assert total > len(found) == 5
    assert all(trial.conditions["load_kg"] in (0.02, 0.03) and trial.kind == "steps" for trial in found)


def test_what_cannot_be_looked_for_is_said(filled):
    with pytest.raises(StoreValueError, match="sort is 'colour'"):
        filled.search_trials(TrialQuery(sort="colour"), limit=1)
    with pytest.raises(StoreValueError, match="at most 8"):
        filled.search_trials(TrialQuery(words=("a",) * 9), limit=1)


def test_days_are_those_of_the_local_time_and_find_their_trials(store, monkeypatch):
    begun = datetime(2026, 3, 1, 23, 30, tzinfo=UTC)
    for at, count in ((begun, 2), (begun + timedelta(hours=2), 3)):
        monkeypatch.setattr(experiments, "now", lambda at=at: at)
        experiment = store.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
        for number in range(count):
            writer = store.begin_trial(experiment, f"{at.hour}-{number}", "steps", {}, ["time_s"])
            writer.finish("completed" if number else "tripped", "", {})
    assert [(one.day, one.experiments, one.trials, one.not_completed) for one in store.days()] == [
        (date(2026, 3, 2), 1, 3, 1),
        (date(2026, 3, 1), 1, 2, 1),
    ]
    assert [(one.day, one.trials) for one in store.days(offset_min=60)] == [(date(2026, 3, 2), 5)]
    wanted = TrialQuery(begun=begin_and_end(date(2026, 3, 2), 0))
    assert names(store.search_trials(wanted, 10)) == ["1-0", "1-1", "1-2"]
    assert len(store.search_trials(TrialQuery(begun=begin_and_end(date(2026, 3, 2), 60)), 10)[0]) == 5
    with pytest.raises(StoreValueError, match="1900 to 2999"):
        begin_and_end(date.min, 60)
