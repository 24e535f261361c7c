"""A model is diagnosed once, however often its diagnosis is asked for; another one is diagnosed anew."""

import pytest

from bench import study
from bench.study import judged


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
    study_id = study.create_study(store, "shared", [experiment_id])["study_id"]
    first = study.diagnose(store, study_id)
    assert study.diagnose(store, study_id) == first
    study.report_html(store, study_id)
    assert len(judgements) == 1


def test_each_model_has_its_own(store, experiment_id, judgements):
    study_id = study.create_study(store, "own", [experiment_id])["study_id"]
    before = study.diagnose(store, study_id)
    model_id = study.add_effect(store, study_id, "viscous_asymmetry")["model_id"]
    after = study.diagnose(store, study_id)
    assert (before["model_id"], after["model_id"]) == (model_id - 1, model_id)
    assert before["sentence"] != after["sentence"]
    assert study.diagnose(store, study_id, model_id - 1) == before
    assert [len(names) for names in judgements] == [len(judgements[0]), len(judgements[0]) + 1]


def test_two_studies_of_the_same_trials_tell_their_own_numbers(store, experiment_id, judgements):
    numbers = [study.create_study(store, name, [experiment_id])["study_id"] for name in ("one", "other")]
    assert [study.diagnose(store, number)["study_id"] for number in numbers] == numbers
    assert len(judgements) == 1
