"""Which trials a study uses, which judge, and what it says when none fit."""

import json
import math
from dataclasses import replace

import pytest

from bench.config.rig import Rig
from bench.recording_set import RecordingSet, import_recording_set
from bench.recording_set.transfer import BY_CONTROL_LOOP
from bench.store.errors import NotFoundError
from bench.study.compare import compare
from bench.study.create import create_study, describe
from bench.study.diagnosis.diagnose import diagnose
from bench.study.errors import StudyError
from bench.study.material import facts_of, load
from tests.lab.synthetic import plans, recordings
from tests.study.conftest import RIG, imported


def roles(study: dict) -> dict[str, str]:
    return {trial.name: trial.role for trial in study.trials}


def test_held_out_trials_are_those_that_meet_a_criterion(store, experiment_id):
    study = create_study(store, "a", [experiment_id], hold_out=["load_kg=0.2", "trial=load-0g-1-1"])
    for trial in study.trials:
        held = trial.conditions["load_kg"] == 0.2 or trial.name == "load-0g-1-1"
        assert trial.role == ("held_out" if held else "training")
    material = load(store, study.study_id)
    held_trials = {index for index, trial in enumerate(study.trials) if trial.role == "held_out"}
    assert set(material.dataset.trial_index[material.training]).isdisjoint(held_trials)
    assert set(material.dataset.trial_index[material.training]) | held_trials == set(range(12))


def test_held_out_trials_do_not_touch_the_parameters(store):
    clean, spoilt = recordings(trials=plans((0.0, 0.2)), seed=1), recordings(trials=plans((0.0, 0.2)), seed=1)
    for recording in spoilt:
        if recording.conditions["load_kg"] == 0.2:
            recording.channels["torque_n_m"] *= 1.5
    found = []
    for made in (clean, spoilt):
        rig = RIG.model_dump(mode="json", exclude_none=True)
        number = store.add_imported("import", {}, {}, rig, [(one, "completed", "") for one in made])
        study = create_study(store, "a", [number], hold_out=["load_kg=0.2"], cutoff_hz=6.0)
        (model,) = store.models(study.study_id)
        found.append(model.result)
    assert found[0]["coefficients"] == found[1]["coefficients"]
    assert found[0]["shapes"] == found[1]["shapes"]
    assert found[0]["held_out"] != pytest.approx(found[1]["held_out"], rel=0.05)


@pytest.mark.parametrize(
    ("criterion", "held"),
    [
        ("trial=load-0g-0-1,load-0g-0-2", 2),
        ("kind=sines", None),
        ("load_kg=0.20", 6),
        ("load_kg = 2e-1", 6),
        ("style=1,2", 8),
    ],
)
def test_how_criteria_are_read(store, experiment_id, criterion, held):
    if held is None:
        with pytest.raises(StudyError, match="hold-out kind=sines takes all 12 trials; leave some to fit"):
            create_study(store, "a", [experiment_id], hold_out=[criterion])
    else:
        study = create_study(store, "a", [experiment_id], hold_out=[criterion], cutoff_hz=6.0)
        assert list(roles(study).values()).count("held_out") == held


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"hold_out": ["load"]}, "'load' is no criterion; wanted key=value, for instance load_kg=0.1"),
        ({"hold_out": ["=0.2"]}, "'=0.2' is no criterion"),
        ({"hold_out": ["load_kg="]}, "'load_kg=' is no criterion"),
        ({"hold_out": ["load_kg=0.3"]}, "no trial has load_kg=0.3; these trials have load_kg = 0.0, 0.2"),
        ({"hold_out": ["load_kg=heavy"]}, "no trial has load_kg=heavy"),
        ({"hold_out": ["colour=red"]}, "no trial has colour=red; the keys of these trials are: arm_m, kind, load_kg"),
        ({"hold_out": ["load_kg=0", "load_kg=0.2"]}, "takes all 12 trials"),
        ({"where": ["load_kg=0.3"]}, "no trial of these experiments has load_kg=0.3"),
        ({"where": ["load_kg=0", "style=7"]}, "no trial of these experiments has load_kg=0 and style=7"),
        ({"where": ["style"]}, "'style' is no criterion"),
        ({"base": ["inertia", "magic"]}, "effect 'magic' is not in the catalogue"),
        ({"base": ["inertia", "viscous", "inertia"]}, "inertia stands twice"),
        ({"cutoff_hz": 0.0}, "cutoff_hz is 0 Hz; wanted is more than 0 Hz"),
        ({"cutoff_hz": float("nan")}, "cutoff_hz is nan Hz"),
        (
            {"cutoff_hz": 1e6},
            r"cutoff_hz is 1e\+06 Hz; at most 40 Hz is wanted for the 200 samples .* of recording 'load-",
        ),
        ({"cutoff_hz": 41.0}, "at most 40 Hz is wanted"),
        ({"cutoff_hz": 0.01}, "samples; at least .* are needed to filter at 0.01 Hz"),
    ],
)
def test_what_is_refused(store, experiment_id, arguments, words):
    before = len(store.studies())
    with pytest.raises(StudyError, match=words):
        create_study(store, "a", [experiment_id], **arguments)
    assert len(store.studies()) == before  # nothing half-made is left


@pytest.mark.parametrize("name", ["", "  "])
def test_a_study_without_a_name_is_refused(store, experiment_id, name):
    with pytest.raises(StudyError, match="the study's name is empty; wanted is one character or more"):
        create_study(store, name, [experiment_id])


def test_held_out_trials_at_rest_judge_nothing(store):
    made = recordings(trials=plans((0.0, 0.2)), seed=1)
    made[1].channels["position_rad"][:] = 0.3
    rig = RIG.model_dump(mode="json", exclude_none=True)
    number = store.add_imported("import", {}, {}, rig, [(one, "completed", "") for one in made])
    with pytest.raises(StudyError, match="hold-out trial=load-0g-1-1 have no row that counts"):
        create_study(store, "a", [number], hold_out=["trial=load-0g-1-1"], cutoff_hz=6.0)
    study = create_study(store, "a", [number], cutoff_hz=6.0)
    compared = compare(store, study.study_id)
    assert math.isnan(compared.trials[1].relative)
    assert json.loads(compared.model_dump_json())["trials"][1]["relative"] is None
    problems = diagnose(store, study.study_id).data_problems
    assert any("does not move in any usable row of theirs: 'load-0g-1-1'" in problem for problem in problems)


def test_where_keeps_some_trials(store, experiment_id):
    study = create_study(store, "a", [experiment_id], where=["load_kg=0", "style=0,1"], cutoff_hz=6.0)
    assert len(study.trials) == 4
    assert {trial.conditions["load_kg"] for trial in study.trials} == {0.0}


def test_rows_and_cutoff_are_kept(store, experiment_id):
    wide = create_study(store, "a", [experiment_id], cutoff_hz=7.5, rows="all")
    assert (wide.cutoff_hz, wide.rows) == (7.5, "all")
    again = describe(store, wide.study_id)
    assert again == wide
    assert load(store, wide.study_id).dataset.cutoff_hz == 7.5
    chosen = create_study(store, "a", [experiment_id])
    assert 2.0 <= chosen.cutoff_hz <= 40.0
    assert chosen.rows == "sliding"
    assert int(load(store, wide.study_id).training.sum()) > int(load(store, chosen.study_id).training.sum())


def test_experiments_are_joined_and_may_be_named_twice(store, experiment_id):
    other = imported(store, plans(loads_kg=(0.1,)))
    study = create_study(store, "a", [experiment_id, other, experiment_id], cutoff_hz=6.0)
    assert len(study.trials) == 15


def test_experiments_that_are_not_fit(store, experiment_id):
    with pytest.raises(StudyError, match="no experiment named"):
        create_study(store, "a", [])
    with pytest.raises(NotFoundError, match="99999"):
        create_study(store, "a", [99999])
    empty = store.begin_experiment("steps", {}, "simulated", {}, RIG.model_dump(mode="json"))
    with pytest.raises(StudyError, match="no completed trial with samples; run them to the end"):
        create_study(store, "a", [empty])
    larger = Rig.model_validate({"name": "larger joint", "arm": {"length_m": 0.5}})
    other = imported(store, plans(loads_kg=(0.1,)), rig=larger)
    with pytest.raises(StudyError, match=f"experiments {experiment_id}, {other} are of different rigs"):
        create_study(store, "a", [experiment_id, other])


def test_a_stopped_trial_is_not_used(store):
    made = recordings(trials=plans((0.0, 0.2)), seed=1)
    outcomes = [(one, "stopped" if index == 2 else "completed", "") for index, one in enumerate(made)]
    number = store.add_imported("import", {}, {}, RIG.model_dump(mode="json", exclude_none=True), outcomes)
    assert made[2].name not in roles(create_study(store, "a", [number], cutoff_hz=6.0))


def test_what_the_lab_is_told_of_a_rig():
    rig = Rig.model_validate(
        {
            "name": "r",
            "horizontal": True,
            "motor": {"torque_constant_n_m_a": 0.05},
            "gear": {"ratio": 100.0, "backlash_rad": 0.01, "stiffness_n_m_rad": 1500.0},
            "sensor": {"counts_per_turn": 4000},
            "arm": {"length_m": 0.4, "mass_kg": 0.2, "centre_of_mass_m": 0.1, "inertia_kg_m2": 0.02},
            "effort": {"quantity": "current"},
        }
    )
    facts = facts_of(rig)
    assert facts.torque_per_current_n_m_a == pytest.approx(5.0)
    assert (facts.gear_ratio, facts.backlash_rad, facts.arm_m, facts.arm_inertia_kg_m2) == (100.0, 0.01, 0.4, 0.02)
    assert facts.stiffness_n_m_rad == 1500.0
    assert facts.arm_moment_n_m == pytest.approx(0.2 * 9.80665 * 0.1)
    assert facts.position_count == pytest.approx(2.0 * math.pi / 400_000)
    assert (facts.joint, facts.horizontal, facts.effort) == ("rotary", True, "current")
    little = facts_of(Rig.model_validate({"name": "r", "gear": {"ratio": 100.0}, "arm": {"mass_kg": 0.2}}))
    assert (little.torque_per_current_n_m_a, little.stiffness_n_m_rad, little.arm_moment_n_m) == (None, None, None)
    assert little.position_count is None


def test_trials_of_our_control_loop_have_its_sampling_delay_wherever_they_are_imported(store):
    made = recordings(trials=plans((0.0, 0.2)), seed=1)
    for told, last in ((BY_CONTROL_LOOP, "measurement_delay"), ({}, "stribeck")):
        these = [replace(one, conditions={**one.conditions, **told}) for one in made]
        number = import_recording_set(store, RecordingSet("set", RIG, these), "a")
        assert create_study(store, "a", [number]).models[0].effects[-1] == last
        assert store.trials(number)[0].conditions.keys() == made[0].conditions.keys()


def test_trials_are_left_out_by_their_names(store, experiment_id):
    study = create_study(store, "a", [experiment_id], leave_out=["load-0g-1-1", "load-200g-2-2"])
    names = [trial.name for trial in study.trials]
    assert len(names) == 10
    assert not {"load-0g-1-1", "load-200g-2-2"} & set(names)
    with pytest.raises(StudyError, match=r"no trial .* is called 'load-0g-1'; the nearest are: .*load-0g-1-1"):
        create_study(store, "a", [experiment_id], leave_out=["load-0g-1"])
    with pytest.raises(StudyError, match=r"'tomorrow'; there are: load-0g-0-1, load-0g-0-2"):
        create_study(store, "a", [experiment_id], leave_out=["tomorrow"])
    with pytest.raises(StudyError, match="takes all 12 trials"):
        create_study(store, "a", [experiment_id], leave_out=[*names, "load-0g-1-1", "load-200g-2-2"])
