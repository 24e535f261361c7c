"""A change of a model whose effect lives on other rows than the study counts: both models are judged on the same."""

import pytest

from bench.study.changes import add_effect, drop_effect
from bench.study.create import create_study


@pytest.mark.parametrize("hold_out", [(), ("load_kg=0.2",)], ids=["one left out in turn", "a load held out"])
def test_an_effect_near_reversals_is_added_and_dropped_on_the_same_rows(store, experiment_id, hold_out):
    """Both models are judged near reversals, whichever has the effect: the gain is the same, turned round."""
    study = create_study(store, "memory", [experiment_id], hold_out, cutoff_hz=6.0).study_id
    added = add_effect(store, study, "backlash")
    dropped = drop_effect(store, study, "backlash", added.model_id)
    assert dropped.before.held_out == pytest.approx(added.after.held_out, rel=1e-6)
    assert dropped.after.held_out == pytest.approx(added.before.held_out, rel=1e-3)
    assert (1.0 - dropped.gain) == pytest.approx(1.0 / (1.0 - added.gain), rel=1e-3)
