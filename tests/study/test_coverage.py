"""What trials can and cannot tell, before any diagnosis; and the report of `explain`."""

from pathlib import Path

import numpy as np
import pytest

from bench.config.rig import Rig
from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.store import Store
from bench.study.create import create_study
from bench.study.diagnosis.diagnose import diagnose
from bench.study.errors import StudyError
from bench.study.explanation.coverage import LOADS, RAMPS, REPEAT, REVERSALS, WARMER, WARMTH, coverage
from bench.study.explanation.explain import STEPS, explain
from bench.study.models.coverage import Coverage
from compensator.lab.recordings.recording import FloatArray, Recording
from tests.lab.synthetic import Joint, Truth, plans, recordings
from tests.study.conftest import RIG, imported

FREE = Rig.model_validate({"name": "free shaft", "horizontal": True})


def told(store: Store, experiment_id: int) -> Coverage:
    return coverage(store, create_study(store, "x", [experiment_id]).study_id)


def lacking(found: Coverage, quantity: str) -> str:
    return next(one.lacking for one in found.held if one.quantity == quantity)


def turning(sign: float, seed: int) -> Recording:
    """A shaft that speeds up and turns on one way, for some hundred turns."""
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, 12.0, 0.005)
    speed = sign * 150.0 * (1.0 - np.exp(-time_s / 3.0))
    torque = 1e-4 * np.gradient(speed, time_s) + 1e-4 * speed + 0.01 * sign + 1e-4 * random.standard_normal(len(time_s))
    channels = {"time_s": time_s, "position_rad": np.cumsum(speed) * 0.005, "torque_n_m": torque}
    return Recording(f"{sign:+g} {seed}", "step", {"sign": sign, "repeat": float(seed)}, channels)


def shaft(store: Store, signs: tuple[float, ...]) -> Coverage:
    trials = [turning(sign, seed) for sign in signs for seed in (1, 2)]
    return told(store, import_recording_set(store, RecordingSet("shaft", FREE, trials), "shaft"))


def test_two_loads_both_ways_and_repeats(store: Store, experiment_id: int) -> None:
    found = told(store, experiment_id)
    assert lacking(found, "directions") == lacking(found, "repeats") == ""
    assert "two loads" in lacking(found, "loads")
    assert lacking(found, "temperature") == ""  # measured, and it warms up
    advised = [one.trial for one in found.advice]
    assert advised[0] == LOADS
    assert not {WARMTH, WARMER, REPEAT} & set(advised)


def test_loads_that_hang_nobody_tells_where_are_told_to_count_as_none(store: Store) -> None:
    trials = recordings(trials=plans(loads_kg=(0.0, 0.2)), seed=3)
    for trial in trials:
        del trial.conditions["arm_m"]
    armless = Rig.model_validate({**RIG.model_dump(exclude_none=True), "arm": {}})
    found = told(store, import_recording_set(store, RecordingSet("set", armless, trials), "armless"))
    assert lacking(found, "loads") == "they count as none: where they hang is not told, arm.length_m of the rig"


def test_a_temperature_that_some_trials_lack_is_told_with_their_names(store: Store) -> None:
    trials = recordings(trials=plans(loads_kg=(0.0, 0.2)), seed=3)
    trials[1].channels["temperature_c"][:] = np.nan
    del trials[4].channels["temperature_c"]
    found = told(store, import_recording_set(store, RecordingSet("set", RIG, trials), "some without"))
    (held,) = [one for one in found.held if one.quantity == "temperature"]
    assert held.found == "no value in load-0g-1-1, load-200g-1-1"
    assert held.lacking.endswith("record temperature_c in every trial, or leave out those without it")


def test_a_trial_too_short_for_the_filter_is_left_out_and_counted(store: Store) -> None:
    trials = [turning(sign, seed) for sign in (1.0, -1.0) for seed in (1, 2)]
    short = {name: values[:60] for name, values in trials[0].channels.items()}
    trials.append(Recording("short", "step", {"sign": 1.0}, short))
    number = import_recording_set(store, RecordingSet("shaft", FREE, trials), "shaft")
    study = create_study(store, "x", [number])
    assert [trial.name for trial in study.trials] == [trial.name for trial in trials[:-1]]
    (held,) = [one for one in coverage(store, study.study_id).held if one.quantity == "trials"]
    assert "1 more too short for the filter at" in held.found
    with pytest.raises(StudyError, match="'short' has 60 samples; at least"):
        create_study(store, "x", [number], cutoff_hz=2.0)


def test_what_is_there_is_not_advised(store: Store) -> None:
    found = told(store, imported(store, plans(loads_kg=(0.0, 0.2, 1.0), repeats=1)))
    assert lacking(found, "loads") == ""
    assert LOADS not in [one.trial for one in found.advice]
    assert REPEAT in [one.trial for one in found.advice]


def test_one_way_only_is_said(store: Store) -> None:
    found = shaft(store, (1.0,))
    assert lacking(found, "directions").startswith("one way only")
    assert WARMTH in [one.trial for one in found.advice], "no temperature is measured"
    assert any("other way round" in one.trial for one in found.advice)


def test_each_direction_a_trial_of_its_own_is_both_directions(store: Store) -> None:
    found = shaft(store, (1.0, -1.0))
    assert lacking(found, "directions") == ""
    assert not any("other way round" in one.trial for one in found.advice)


def test_a_shaft_that_turns_on_has_no_spring(store: Store) -> None:
    found = shaft(store, (1.0, -1.0))
    assert "turns on" in lacking(found, "position")
    spring = next(one for one in found.effects if one.effect == "spring")
    assert (spring.standing, "shaft turns on" in spring.reason) == ("not measured", True)


def test_what_a_diagnosis_does_not_judge_cannot_be_judged_before_it(store: Store) -> None:
    """Both count the rows near reversals by the same rule."""
    found = shaft(store, (1.0, -1.0))
    last = diagnose(store, found.study_id)
    not_judged = {str(one.values["effect"]): one.text for one in last.findings if one.code == "not-judged"}
    by_name = {one.effect: one for one in found.effects}
    assert "rows lie near one, wanted 40" in not_judged["backlash"]
    assert not set(not_judged) & {one.effect for one in found.effects if one.standing == "judgeable"}
    for name in ("backlash", "elasticity", "pre_sliding"):
        assert by_name[name].standing == "not measured"
        assert by_name[name].reason in not_judged[name]
    assert REVERSALS in [one.trial for one in found.advice]


def test_what_a_free_scale_hides_is_hidden_for_the_same_reason_as_in_a_diagnosis(
    store: Store, experiment_id: int
) -> None:
    found = told(store, experiment_id)
    last = diagnose(store, found.study_id)
    not_judged = {str(one.values["effect"]): one.text for one in last.findings if one.code == "not-judged"}
    for name in ("back_driving_friction", "coulomb_asymmetry"):
        hides = next(one for one in found.effects if one.effect == name)
        assert (hides.standing, hides.rivals) == ("hidden", [])
        assert hides.reason.startswith(f"{name} hides in the free scale of ")
        assert hides.reason in not_judged[name]


def test_an_effect_that_hides_and_effects_that_look_alike(store: Store) -> None:
    found = told(store, imported(store, plans(loads_kg=(0.1,), repeats=1)))
    by_name = {one.effect: one for one in found.effects}
    assert by_name["coulomb_asymmetry"].standing == "hidden"
    assert "load_friction_quadratic" in by_name["load_friction"].rivals  # one load: a line and a curve are one
    assert by_name["viscous_asymmetry"].standing == "judgeable"
    assert RAMPS in [one.trial for one in found.advice]
    starts = next(one for one in found.held if one.quantity == "starts from rest")
    assert starts.lacking.startswith("12 are needed")


@pytest.mark.timeout(300)
def test_explain_ends_in_a_report_of_one_page(store: Store, experiment_id: int, tmp_path: Path) -> None:
    steps: list[tuple[str, int]] = []
    found = explain(store, experiment_id, "known joint", lambda step, number: steps.append((step, number)))
    assert steps == list(zip(STEPS, range(len(STEPS)), strict=True))
    assert any("viscous asymmetry" in sentence for sentence in found.sentences)
    for words in ("What these data can and cannot tell", "Before and after", "What to record next", "<script"):
        assert words in found.html
    assert "http://" not in found.html.split("<script")[0]


def test_explain_goes_on_beside_a_curve_where_no_formula_follows(store: Store) -> None:
    """A friction that catches at one place, and drag that differs by direction, which shows beside it."""

    def law(x: Truth) -> FloatArray:
        caught = 0.12 * np.exp(-(((x.q - 0.2) / 0.4) ** 2)) * np.sign(x.v)
        return caught + 0.012 * np.abs(x.v)

    experiment_id = imported(store, plans(), Joint(extra=law))
    found = explain(store, experiment_id, "a cable that catches", lambda step, number: None)
    added = [rung.added for rung in found.rungs.rungs]
    assert "curve_of_position_against_motion" in added
    assert "viscous_asymmetry" in found.rungs.rungs[-1].effects
    assert found.rungs.rungs[-1].held_out < 0.5 * found.rungs.rungs[0].held_out


@pytest.mark.parametrize("warmest_c", [25.2, 27.7])
def test_what_the_temperature_leaves_open_is_what_is_said_of_its_effects(store: Store, warmest_c: float) -> None:
    """A table that says that effects of temperature cannot be seen stood above one that could be judged."""
    found = told(store, imported(store, plans(repeats=1, temperatures_c=(25.0, warmest_c, 25.1))))
    names = {"viscous_temperature", "coulomb_temperature", "winding_temperature"}
    effects = [one for one in found.effects if one.effect in names]
    shown = [one.smallest for one in effects if one.standing in ("judgeable", "confounded")]
    assert bool(shown) == (warmest_c > 26.0)
    least = f"less than 5 K: effects of temperature show from {min(shown, default=0.0):.2%} of the effort on"
    assert lacking(found, "temperature") == (least if shown else "effects of temperature cannot be seen")
    advised = [one.trial for one in found.advice]
    assert WARMER in advised or shown
    assert WARMTH not in advised, "the channel is there: its range is too small"
