"""A model refitted to experiments of any length: against the fit in memory, in pieces, and what is refused."""

import sys
from dataclasses import replace

import pytest

from bench.recording_set import RecordingSet, import_recording_set
from bench.store.errors import NotFoundError
from bench.study.create import create_study
from bench.study.errors import NothingNewError, StudyError
from bench.study.extend import extend_study
from bench.study.keep import kept_of
from bench.study.refit import refit
from tests.lab.synthetic import plans, recordings
from tests.study.conftest import RIG, imported


@pytest.fixture(scope="module")
def study_id(store, experiment_id) -> int:
    return create_study(store, "some", [experiment_id], cutoff_hz=6.0).study_id


def test_on_the_trials_of_the_study_itself_the_model_stays_as_it_is(store, study_id, experiment_id):
    found = refit(store, study_id, [experiment_id])
    assert found.trials == 12
    assert found.samples == 12 * 1800
    assert [one.all for one in found.parameters] == pytest.approx(
        [one.study for one in found.parameters], rel=1e-6, abs=1e-9
    )
    assert found.skipped == []


def test_more_trials_move_the_parameters_within_reason(store, study_id, experiment_id):
    more = imported(store, plans(loads_kg=(0.1,), seed=9))
    found = refit(store, study_id, [experiment_id, more])
    assert found.trials == 15
    inertia = next(one for one in found.parameters if one.effect == "inertia")
    assert inertia.all == pytest.approx(inertia.study, rel=0.05)
    assert inertia.all != inertia.study


def test_long_trials_are_read_in_pieces(store, study_id, experiment_id, monkeypatch):
    whole = refit(store, study_id, [experiment_id])
    for module in ("compensator.lab.model.streaming", "bench.study.refit"):
        monkeypatch.setattr(sys.modules[module], "PIECE_ROWS", 900)
    found = refit(store, study_id, [experiment_id])
    assert found.rows == pytest.approx(whole.rows, rel=0.03)
    assert found.training == pytest.approx(whole.training, rel=0.05)
    assert found.trials == 12


def test_another_rig_and_unknown_experiments_are_refused(store, study_id):
    lying = RIG.model_copy(update={"horizontal": True})
    other = imported(store, plans(loads_kg=(0.1,)), rig=lying)
    with pytest.raises(StudyError, match="another rig"):
        refit(store, study_id, [other])
    with pytest.raises(NotFoundError):
        refit(store, study_id, [998])


def test_a_shape_of_an_earlier_version_with_fewer_values_is_not_kept(store, study_id):
    model = store.models(study_id)[0]
    shapes = {"backlash": [0.01], "stribeck": [0.2, 2.0], "of_a_package_that_is_gone": [1.0]}
    found = kept_of(replace(model, result={**model.result, "shapes": shapes})).shapes
    assert found.keys() == {"stribeck", "of_a_package_that_is_gone"}


def test_trials_without_the_effort_of_the_study_are_left_out_and_told(store, study_id, experiment_id):
    made = recordings(trials=plans(loads_kg=(0.1,), seed=9), seed=3)
    del made[0].channels["torque_n_m"]
    made[1].channels["torque_n_m"][:] = float("nan")
    made[0].channels["current_a"] = made[2].channels["torque_n_m"]
    some = import_recording_set(store, RecordingSet("set", RIG, made), "some without")
    found = refit(store, study_id, [experiment_id, some])
    assert found.trials == 13
    assert ["load-100g-0-1" in found.skipped[0], "load-100g-1-1" in found.skipped[1]] == [True, True]
    assert all("has no effort channel: found" in one and "; wanted torque_n_m; " in one for one in found.skipped)
    extended = extend_study(store, create_study(store, "more", [experiment_id]).study_id, [some])
    assert [one.name for one in extended.added] == ["load-100g-2-1"]
    assert extended.left_out == ["load-100g-0-1", "load-100g-1-1"]
    none = import_recording_set(store, RecordingSet("set", RIG, made[:1]), "all without")
    with pytest.raises(NothingNewError, match=r"has not yet \('load-100g-0-1': too short .*, or without its effort"):
        extend_study(store, study_id, [none])
