"""A model is diagnosed once, however often its diagnosis is asked for; another one is diagnosed anew."""

from itertools import count
from types import SimpleNamespace
from typing import Any

import pytest

from bench.study.changes import add_effect
from bench.study.create import create_study
from bench.study.diagnosis import judged
from bench.study.diagnosis.diagnose import diagnose
from bench.study.diagnosis.findings import numbers_explained
from bench.study.models.diagnosis import Ranked
from bench.study.report.report import report_html


@pytest.fixture
def judgements(monkeypatch):
    """Models that were diagnosed, in order."""
    asked = []
    diagnose = judged.diagnose

    def counted(fit):
        asked.append(fit.names)
        return diagnose(fit)

    judged._kept.cache_clear()
    monkeypatch.setattr(judged, "diagnose", counted)
    return asked


def test_page_and_report_share_one_diagnosis(store, experiment_id, judgements):
    study_id = create_study(store, "shared", [experiment_id]).study_id
    first = diagnose(store, study_id)
    assert diagnose(store, study_id) == first
    report_html(store, study_id)
    assert len(judgements) == 1


def test_each_model_has_its_own(store, experiment_id, judgements):
    study_id = create_study(store, "own", [experiment_id]).study_id
    before = diagnose(store, study_id)
    model_id = add_effect(store, study_id, "viscous_asymmetry").model_id
    after = diagnose(store, study_id)
    assert (before.model_id, after.model_id) == (model_id - 1, model_id)
    assert before.sentence != after.sentence
    assert diagnose(store, study_id, model_id - 1) == before
    assert [len(names) for names in judgements] == [len(judgements[0]), len(judgements[0]) + 1]


def test_two_studies_of_the_same_trials_tell_their_own_numbers(store, experiment_id, judgements):
    numbers = [create_study(store, name, [experiment_id]).study_id for name in ("one", "other")]
    assert [diagnose(store, number).study_id for number in numbers] == numbers
    assert len(judgements) == 1


@pytest.fixture
def ask(monkeypatch):
    """Ask for the diagnosis of a model; each one made is another number."""
    numbers = count()
    monkeypatch.setattr(judged, "diagnose", lambda fit: next(numbers))
    judged._kept.cache_clear()

    def asked(
        source: object = "store", definition: str = "all trials", effects=("gravity", "stribeck"), speed=0.1
    ) -> Any:
        material = SimpleNamespace(source=source, definition=definition)
        model = SimpleNamespace(effects=list(effects), result={"shapes": {"stribeck": [speed, 1.0]}})
        return judged.diagnosis_of_model(material, model, None)

    yield asked
    judged._kept.cache_clear()


@pytest.mark.parametrize(
    "other",
    [{"source": "another"}, {"definition": "one held out"}, {"effects": ("gravity",)}, {"speed": 0.2}],
)
def test_another_store_study_model_or_shape_is_another_question(ask, other):
    assert [ask(), ask(**other), ask()] == [0, 1, 0]


def test_material_of_no_store_is_asked_each_time(ask):
    """Nothing says that it is the same."""
    assert [ask(source=None), ask(source=None)] == [0, 1]


def ranked(effect, before, after, gain):
    return Ranked.model_construct(
        effect=effect, held_out_before=before, held_out_after=after, gain=gain, gain_low=gain, gain_high=gain
    )


ALIKE = ranked("viscous_asymmetry", 0.02, 0.01, 0.5)


@pytest.mark.parametrize(
    ("ranking", "told"),
    [
        ([], ""),
        ([ALIKE, ranked("spring", 0.02, 0.019, 0.05)], ""),
        ([ALIKE, ranked("backlash", 0.02, 0.019, 0.05)], ""),
        (
            [ALIKE, ranked("spring", 0.02, 0.019, 0.3)],
            "Errors count all rows alike; gains count each row by how well it is known.",
        ),
        ([ALIKE, ranked("backlash", 0.04, 0.02, 0.5)], "Effects near reversals have errors of their own rows."),
    ],
)
def test_what_a_reader_of_errors_and_gains_would_stumble_over_is_explained_where_it_is(ranking, told):
    assert numbers_explained(ranking) == told
