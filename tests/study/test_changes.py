"""A change of a model whose effect lives on other rows than the study counts: both models are judged on the same."""

import pytest

from bench.study import changes
from bench.study.changes import add_effect, drop_effect
from bench.study.create import create_study
from bench.study.ladder import ladder
from bench.study.material import load_model
from compensator.lab.diagnosis.physical import TOLD, Impossible
from compensator.lab.model.fit import widened
from compensator.lab.model.gain import Gain
from compensator.lab.model.validation import held_out


@pytest.mark.parametrize("hold_out", [(), ("load_kg=0.2",)], ids=["one left out in turn", "a load held out"])
def test_an_effect_near_reversals_is_added_and_dropped_on_the_same_rows(store, experiment_id, hold_out):
    """Both models are judged near reversals, whichever has the effect: the gain is the same, turned round."""
    study = create_study(store, "memory", [experiment_id], hold_out, cutoff_hz=6.0).study_id
    added = add_effect(store, study, "backlash")
    dropped = drop_effect(store, study, "backlash", added.model_id)
    assert (added.rows, added.ladder_rows) == ("near reversals too", "steady sliding")
    steps = ladder(store, study)
    assert steps.rows == "steady sliding"
    assert [rung.held_out for rung in steps.rungs[:2]] == [added.ladder_before, added.ladder_after]
    assert added.ladder_before != added.before.held_out, "each is of the rows that it names"
    assert dropped.before.held_out == pytest.approx(added.after.held_out, rel=1e-6)
    assert dropped.after.held_out == pytest.approx(added.before.held_out, rel=1e-3)
    assert (1.0 - dropped.gain) == pytest.approx(1.0 / (1.0 - added.gain), rel=1e-3)
    material, row = load_model(store, study, added.model_id)
    seen = widened(material.fit_of(row), "moving")  # as a diagnosis judges it
    assert added.after.held_out == pytest.approx(held_out(seen, "moving").relative, rel=1e-6)


@pytest.mark.parametrize(
    ("why", "end"),
    [
        ("distance 0.273 rad is the most that it can be",
         "But distance 0.273 rad is the most that it can be: leave it out."),
        (TOLD, "It is known from the rig, and no find; it helps: keep it."),
        ("", "It helps: keep it."),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said_when_it_is_added(store, experiment_id, monkeypatch, why, end):
    study = create_study(store, "memory", [experiment_id], (), cutoff_hz=6.0).study_id
    monkeypatch.setattr(changes, "why_impossible", lambda *_: Impossible(why, ""))
    monkeypatch.setattr(changes, "held_out_gain", lambda *_: Gain(0.2, 0.1, 0.3))
    assert add_effect(store, study, "pre_sliding").sentence.endswith(end)
