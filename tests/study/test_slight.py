"""What is named, and next to nothing beside what was added, is no reason to add another effect."""

from dataclasses import replace

import pytest

from bench.evaluation.challenge.guess import guess_of_study
from bench.study.changes import add_effect
from bench.study.create import create_study
from bench.study.diagnosis import diagnose as study
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.material import load_model
from compensator.lab.model.gain import Gain
from tests.lab.synthetic import plans
from tests.study.conftest import imported

ADDED = 0.108  # of the effort, root mean square: what an effect explains that was added


@pytest.fixture(scope="module")
def number(store) -> int:
    return create_study(store, "slight", [imported(store, plans(loads_kg=(0.0, 0.2), repeats=2))]).study_id


@pytest.fixture(scope="module")
def answer(store, number):
    """The answer where a named effect takes an error somewhere."""
    material, model = load_model(store, number, None)
    fit = material.fit_of(model)
    found = diagnosis_of_model(material, model, fit)

    def answered(before: float, after: float, gain: Gain, explained: float):
        first = replace(found.candidates[0], before=before, after=after, gain=gain)
        changed = replace(found, candidates=[first, *found.candidates[1:]])
        return study.answer_of(fit, changed, number, model.id, explained)

    return answered


def test_a_small_second_effect_is_slight_and_said_to_be(answer):
    found = answer(0.0106, 0.0103, Gain(0.03, 0.01, 0.06), ADDED)
    assert found.slight
    assert found.verdict == "missing"  # the evidence is what it is
    assert found.advice.startswith("Next to nothing is left: Direction-asymmetric viscous friction would take 3%")


@pytest.mark.parametrize(
    ("before", "after", "gain", "explained"),
    [
        (0.0106, 0.0103, Gain(0.03, 0.01, 0.06), 0.0),  # nothing was added: the first effect is never slight
        (0.0106, 0.0053, Gain(0.5, 0.4, 0.6), ADDED),  # half of the error goes
        (0.0106, 0.0103, Gain(0.03, 0.01, 0.06), 0.02),  # as much as a good part of what was added
    ],
)
def test_what_matters_is_not_slight(answer, before, after, gain, explained):
    found = answer(before, after, gain, explained)
    assert not found.slight
    assert found.advice == ""


def test_what_was_added_and_explains_all_leaves_nothing_slight_in_the_guess(store, number, monkeypatch):
    add_effect(store, number, "viscous_asymmetry")
    _, model = load_model(store, number, None)
    assert study.explained_by(store, model) > 0.01
    last = study.diagnose(store, number, model.parent_id)
    told = last.model_copy(update={"slight": True})
    monkeypatch.setattr("bench.evaluation.challenge.guess.diagnose", lambda *_: told)
    assert guess_of_study(store, number).classes == (("viscous_asymmetry",),)
    monkeypatch.setattr("bench.evaluation.challenge.guess.diagnose", lambda *_: last)
    assert len(guess_of_study(store, number).classes) == 2
