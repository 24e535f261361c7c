"""From a diagnosis to the trials that settle it, on a simulated bench."""

import importlib
import json
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.runs.runner import Runner
from bench.study.compare import compare
from bench.study.create import create_study, describe
from bench.study.diagnosis import judged
from bench.study.diagnosis.diagnose import diagnose
from bench.study.errors import StudyError
from bench.study.explanation.coverage import coverage
from bench.study.extend import extend_study
from bench.study.ladder import ladder
from bench.study.material import load
from bench.study.models.study import note_for
from bench.study.suggestion.options import LONGEST_S, choices
from bench.study.suggestion.predict import predicted
from bench.study.suggestion.suggest import suggest
from compensator.lab.at_rest.breakaway_rows import breakaway_rows
from compensator.lab.next_trial.suggestion import Pair, Pick, Suggestion
from compensator.lab.rows.assembly import more_trials

SUGGEST = importlib.import_module("bench.study.suggestion.suggest")  # the package has the function of that name
MOTIONS = {
    "loads_kg": [0.0, 0.05], "waveforms": ["slow-sine", "fast-sine"], "duration_s": 5.0, "repeats": 1,
    "speed_rad_s": 2.0,
}  # fmt: skip


def bench_with(plant):
    found = default_configuration()
    return found.model_copy(update={"drive": found.drive.model_copy(update={"plant": plant, "seed": 4})})


CONFIGURATION = bench_with({"spring": {"stiffness_n_m_rad": 0.03}})


def run(store, kind, parameters, note="", configuration=CONFIGURATION, outcome="completed"):
    runner = Runner(configuration, store)
    number = runner.start(kind, parameters, note=note)
    assert runner.wait(60.0)
    runner.close()
    assert store.experiment(number).outcome == outcome, store.experiment(number).reason
    return number


@pytest.fixture(scope="module")
def made(store):
    return create_study(store, "to be settled", [run(store, "excitation", MOTIONS)])


@pytest.fixture(autouse=True)
def few_options(monkeypatch):
    """Every ninth option: the whole lot takes seconds."""
    monkeypatch.setattr(SUGGEST, "choices", lambda *args: choices(*args)[::9])


@pytest.fixture(scope="module")
def found(store, made):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(SUGGEST, "choices", lambda *args: choices(*args)[::9])
        return suggest(store, made.study_id, CONFIGURATION, trials=2)


def test_every_option_is_one_that_the_bench_may_run():
    found = choices(CONFIGURATION, hung_by_hand=False)
    kinds = {one.kind for one in found}
    assert {"excitation", "steps", "speed-sweep", "load-sweep"} <= kinds
    assert "commissioning" not in kinds
    assert len({one.name for one in found}) == len(found)
    assert all(0.0 < one.duration_s <= LONGEST_S for one in found)
    by_hand = choices(CONFIGURATION, hung_by_hand=True)
    assert all(slow.duration_s > quick.duration_s for slow, quick in zip(by_hand, found, strict=True))
    narrow = CONFIGURATION.limits.model_copy(update={"position_min_rad": -0.5, "position_max_rad": 0.5})
    inside = choices(CONFIGURATION.model_copy(update={"limits": narrow}), hung_by_hand=False)
    assert all(one.parameters["amplitude_rad"] < 0.5 for one in inside if one.kind == "excitation")
    assert "steps" not in {one.kind for one in inside}


def test_where_starts_from_rest_tell_ramps_of_every_rate_are_run_on_the_model_after_every_rest(store, made):
    found = choices(CONFIGURATION, hung_by_hand=False, from_rest=True)
    assert {one.kind for one in found} == {"breakaway-ramps"}
    told = [(one.parameters["rates_a_s"][0], one.parameters["dwells_s"][0]) for one in found]
    assert max(rate for rate, _ in told) >= 10.0 * min(rate for rate, _ in told)
    assert max(dwell for _, dwell in told) >= 10.0 * min(dwell for _, dwell in told)
    number = store.trial(made.trials[0].trial_id).experiment_id
    material = load(store, create_study(store, "quick", [number], cutoff_hz=8.0).study_id)
    fit = material.fit(list(material.definition.base))
    chosen = [one for one in found if one.parameters["load_kg"] == 0.0 and one.parameters["dwells_s"] == [2.0]][:2]
    dataset = more_trials(fit.dataset, [one for o in predicted(fit, CONFIGURATION, chosen) for one in o.recordings])
    starts = breakaway_rows(replace(fit, dataset=dataset, training=np.ones(len(dataset.trial_index), dtype=bool)))
    assert len(starts) == 4  # there and back, each
    np.testing.assert_allclose(starts.direction, [1.0, -1.0, 1.0, -1.0])
    assert (starts.rest_s > 2.0).all()
    assert starts.rate[2] > 2.0 * starts.rate[0]


def test_a_suggestion_can_be_started_as_it_is(store, made, found):
    json.loads(found.model_dump_json())
    assert found.trials, found.sentence
    assert f"rises from {found.trials[0].before:.1f} to {found.trials[-1].after:.1f}" in found.sentence
    assert found.note == note_for(made.study_id)
    assert all(re.match(r"It tells .* from .*: they differ by", one.sentence) for one in found.trials)
    number = run(store, found.trials[0].kind, found.trials[0].parameters, found.note)
    before = diagnose(store, made.study_id, made.model_id)
    extended = extend_study(store, made.study_id)
    assert [one.trial_id for one in extended.added] == [trial.id for trial in store.trials(number)]
    described = describe(store, made.study_id)
    assert len(described.trials) == len(made.trials) + len(extended.added)
    assert all(one.role == "training" for one in described.trials)
    # the first model stays what it was: compared and diagnosed on its own trials
    assert diagnose(store, made.study_id, made.model_id).model_dump_json() == before.model_dump_json()
    assert len(compare(store, made.study_id, made.model_id).trials) == len(made.trials)
    assert len(compare(store, made.study_id).trials) == len(described.trials)
    rungs = ladder(store, made.study_id).rungs
    assert [rung.trials for rung in rungs] == [len(made.trials), len(described.trials)]
    assert rungs[1].effects == rungs[0].effects
    with pytest.raises(StudyError, match="no completed trial that study"):
        extend_study(store, made.study_id)


def test_a_simulated_joint_which_repeats_its_samples_is_not_asked_for_the_same_trial_again(store, monkeypatch):
    alone = [one for one in choices(CONFIGURATION, hung_by_hand=False) if one.kind == "excitation"][:2]
    monkeypatch.setattr(SUGGEST, "choices", lambda *_: alone)
    number = run(store, "excitation", MOTIONS)
    made = create_study(store, "repeats", [number])
    found = suggest(store, made.study_id, CONFIGURATION, trials=6)
    names = [one.name for one in found.trials]
    assert names
    assert len(set(names)) == len(names)
    first = found.trials[0]
    extend_study(store, made.study_id, [run(store, first.kind, first.parameters)])
    again = suggest(store, made.study_id, CONFIGURATION, trials=6)
    assert first.name not in [one.name for one in again.trials]


@pytest.mark.parametrize(("promised", "told"), [(5.5, "to at least 4.0 in nine of ten"), (0.0, "That is no promise")])
def test_a_suggestion_says_what_of_its_prediction_is_promised(promised, told):
    pairs = (Pair("spring", None, 1.0, 7.0, 9.0, 4.0, promised), Pair("spring", "cogging", 1.5, 8.0, 9.0, 4.0, 4.0))
    pick = Pick("one", 0.5, 1.0, 7.0, ("spring", None), 0.01)
    assert told in SUGGEST._sentence(Suggestion(pairs, (), (pick,), 0.01), says("missing", "spring"))


def says(verdict, *names):
    return SimpleNamespace(verdict=verdict, classes=[names], named=names, too_short=False)


@pytest.mark.parametrize(("names", "told"), [(["spring"], True), (["spring", "cogging"], False)])
def test_what_a_diagnosis_names_alone_is_named_in_a_suggestion_too(names, told):
    pick = Pick("one", 0.5, 1.0, 7.0, ("spring", None), 0.01)
    found = Suggestion((Pair("spring", "cogging", 1.0, 7.0, 9.0, 4.0, 6.0),), (), (pick,), 0.01)
    assert ("What is named gets surer" in SUGGEST._sentence(found, says("missing", *names))) == told


def test_trials_that_are_too_short_to_tell_have_no_rivals(store):
    number = run(store, "excitation", {**MOTIONS, "loads_kg": [0.05], "waveforms": ["slow-sine"]})
    study = create_study(store, "short", [number]).study_id
    short = diagnose(store, study)
    assert short.conclusion.code == "too-short"
    assert "few-trials" in [one.code for one in short.findings]
    found = suggest(store, study, CONFIGURATION, trials=1)
    assert found.trials
    assert found.sentence.startswith("Record this trial (")
    assert found.pairs == []
    assert "d'" not in found.sentence
    told = coverage(store, study)
    assert told.sentence == short.sentence
    assert [one.code for one in told.findings] == ["few-trials"]
    assert not {"judgeable", "confounded"} & {one.standing for one in told.effects}


def test_a_pair_that_no_trial_tells_apart_is_listed_once():
    pairs = (
        Pair("spring", "cogging", 0.1, 0.1, 0.2, 0.1, 0.0), Pair("cogging", "spring", 0.1, 0.1, 0.2, 0.1, 0.0),
        Pair("cogging", None, 0.1, 0.1, 0.2, 0.1, 0.0),
    )  # fmt: skip
    told = SUGGEST._sentence(Suggestion((), pairs, (), 0.01), says("missing"))
    assert told.endswith("spring or cable torque and cogging; cogging and no effect.")


@pytest.mark.parametrize(("verdict", "supposes"), [("nothing", True), ("missing", False)])
def test_where_nothing_is_sure_a_suggestion_says_what_it_supposes(verdict, supposes):
    pairs = (Pair("spring", None, 1.0, 7.0, 9.0, 4.0, 6.0), Pair("cogging", "spring", 1.5, 8.0, 9.0, 4.0, 0.0))
    pick = Pick("one", 0.5, 1.0, 7.0, ("spring", None), 0.01)
    told = SUGGEST._sentence(Suggestion(pairs, (), (pick,), 0.01), says(verdict, "spring"))
    assert "rises from 1.0 to 7.0" in told
    assert ("It supposes that one of spring or cable torque and cogging is missing" in told) == supposes


@pytest.mark.parametrize(("now", "told"), [(2.4, True), (5.9, False)])
def test_a_d_prime_that_fell_with_the_trials_that_were_added_is_told(store, monkeypatch, now, told):
    study = create_study(store, "falls", [run(store, "excitation", MOTIONS)]).study_id
    seen = []

    def d_prime_of(fit, _diagnosis, _name):
        seen.append(len(fit.dataset.trials))
        return 5.7 if len(seen) == 1 else now

    monkeypatch.setattr("bench.study.suggestion.since.d_prime_of", d_prime_of)
    suggest(store, study, CONFIGURATION, trials=1)
    assert seen == []  # there is nothing before
    extended = extend_study(store, study, [run(store, "excitation", {**MOTIONS, "speed_rad_s": 1.5})])
    sentence = suggest(store, study, CONFIGURATION, trials=1).sentence
    assert seen == [extended.trials - len(extended.added), extended.trials]
    assert (" fell from 5.7 to 2.4. The rivals are closer than the model said." in sentence) == told
    assert "The rivals are closer" not in suggest(store, study, CONFIGURATION, trials=1, since_before=False).sentence
    assert len(seen) == 2


def test_suggestions_start_from_the_diagnosis_that_was_made(store, made, found, monkeypatch):
    monkeypatch.setattr(judged, "diagnose", None)  # nothing is judged again
    again = suggest(store, made.study_id, CONFIGURATION, made.model_id, trials=2)
    assert (again.verdict, again.diagnosis) == (found.verdict, found.diagnosis)


def test_what_tripped_on_the_joint_is_named_and_not_suggested_again_until_it_completes(store, made, found):
    one = found.trials[0]
    fault = {"kind": "encoder-jump", "at_s": 0.4, "jump_rad": 1.0}
    drive = default_configuration().drive.model_dump() | {"plant": CONFIGURATION.drive.plant, "faults": [fault]}
    faulty = type(CONFIGURATION).model_validate({**CONFIGURATION.model_dump(), "drive": drive})
    number = run(store, one.kind, one.parameters, found.note, faulty, outcome="tripped")
    again = suggest(store, made.study_id, CONFIGURATION, made.model_id, trials=2)
    assert [(out.experiment_id, out.outcome) for out in again.kept_out] == [(number, "tripped")]
    assert "speed" in again.kept_out[0].reason
    assert again.trials
    assert one.name not in [other.name for other in again.trials]
    (other, *_) = again.trials
    third = suggest(store, made.study_id, CONFIGURATION, made.model_id, 2, [other.name])
    assert not {one.name, other.name} & {trial.name for trial in third.trials}
    store.annotate(run(store, one.kind, one.parameters, found.note), note="")
    store.annotate(number, note="")


def test_what_is_held_out_by_condition_is_not_suggested_and_stays_held_out(store, made):
    number = run(store, "excitation", {**MOTIONS, "repeats": 2})
    held = create_study(store, "held", [number], hold_out=["load_kg=0.05"])
    found = suggest(store, held.study_id, CONFIGURATION, trials=1)
    assert all(0.05 not in one.parameters.get("loads_kg", []) for one in found.trials)
    again = run(store, "excitation", MOTIONS)
    extend_study(store, held.study_id, [again])
    roles = {one.trial_id: (one.role, one.conditions["load_kg"]) for one in describe(store, held.study_id).trials}
    added = [roles[trial.id] for trial in store.trials(again)]
    assert set(added) == {("held_out", 0.05), ("training", 0.0)}


def test_another_rig_is_refused(store, made):
    rig = CONFIGURATION.rig.model_copy(update={"arm": CONFIGURATION.rig.arm.model_copy(update={"length_m": 0.7})})
    other = CONFIGURATION.model_copy(update={"rig": rig})
    with pytest.raises(StudyError, match=r"of another rig than this bench.*friction-bench study coverage \d+"):
        suggest(store, made.study_id, other)
    number = run(store, "excitation", MOTIONS, configuration=other)
    with pytest.raises(StudyError, match=f"experiment {number} is of another rig"):
        extend_study(store, made.study_id, [number])


def test_without_any_inertia_nobody_can_tell_what_a_trial_shows(store):
    rig = CONFIGURATION.rig.model_copy(update={"arm": CONFIGURATION.rig.arm.model_copy(update={"inertia_kg_m2": None})})
    configuration = CONFIGURATION.model_copy(update={"rig": rig})
    number = run(store, "excitation", MOTIONS, configuration=configuration)
    still = create_study(store, "still", [number], base=["gravity", "coulomb"])
    with pytest.raises(StudyError, match="neither the model nor the rig tells the inertia"):
        suggest(store, still.study_id, configuration)
