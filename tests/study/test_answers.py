"""Compare, diagnose, add, drop, ladder: what they answer, and that their numbers agree."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from bench.cli.output import print_json
from bench.store.errors import NotFoundError
from bench.study.changes import _sentence, add_effect, drop_effect
from bench.study.compare import compare
from bench.study.create import create_study, describe
from bench.study.diagnosis.diagnose import _ranking, answer_of, diagnose
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.diagnosis.search import search
from bench.study.effects import effects_catalogue
from bench.study.errors import StudyError
from bench.study.ladder import ladder
from bench.study.material import load, load_model
from bench.study.models.base import StudyModel
from bench.study.models.study import Study
from compensator.lab.diagnosis import diagnosis as lab
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.gain import Gain
from tests.lab.synthetic import Joint, plans
from tests.study.conftest import imported


@pytest.fixture(scope="module")
def study(store, experiment_id) -> Study:
    return create_study(store, "joint", [experiment_id], hold_out=["repeat=2"], cutoff_hz=6.0)


@pytest.fixture(scope="module")
def story(store, study) -> dict[str, StudyModel]:
    """The whole of a study, in the order of its use."""
    number = study.study_id
    told = {"compare": compare(store, number), "diagnose": diagnose(store, number)}
    told["add"] = add_effect(store, number, told["diagnose"].ranking[0].effect)
    told["compare after"] = compare(store, number)
    told["diagnose after"] = diagnose(store, number)
    told["drop"] = drop_effect(store, number, "viscous_asymmetry")
    told["ladder"] = ladder(store, number)
    return told


def test_the_hidden_effect_is_named_added_and_helps(story):
    found = story["diagnose"]
    assert found.verdict == "missing"
    assert found.ranking[0].effect == "viscous_asymmetry"
    assert found.classes[0].effects[0] == "viscous_asymmetry"
    assert [one.effect for one in found.ranking if one.in_class] == found.classes[0].effects
    assert story["add"].gain_low > 0
    assert "It helps: keep it." in story["add"].sentence
    assert story["drop"].sentence.endswith("Dropping it harms: add it again.")
    whole = story["compare after"].parameters
    assert story["add"].parameters == [one for one in whole if one.effect == "viscous_asymmetry"] != []
    assert story["drop"].parameters == []
    after = story["diagnose after"]
    assert after.verdict == "nothing"
    assert after.classes == []
    assert not any(one.in_class for one in after.ranking)


def test_what_is_not_named_says_what_it_lacks(story):
    found, after = story["diagnose"].ranking, story["diagnose after"].ranking
    assert found[0].why_not == []
    assert all(one.why_not or one.in_class for one in found), "no row leaves the reader without a reason"
    assert all(one.why_not for one in after), "nothing is named beside it"
    for one in (*found, *after):
        assert ("score not above 0" in one.why_not) == (one.score <= 0.0)
        assert "impossible size, sign or shape" not in one.why_not, "its own reason is told"
        assert ("not named: " in one.sentence) == bool(one.why_not)
        assert all(doubt in one.sentence for doubt in one.why_not)


def test_the_ranking_is_in_the_order_that_it_says():
    """The lab lists one family of effects after the other."""
    listed = [
        ("spring", 40.0, True),
        ("stribeck", 5.0, False),
        ("coulomb_asymmetry", 30.0, True),
        ("cogging", 90.0, False),
    ]
    candidates = [
        Candidate(effect_named(name), (), score, 0.001 if sure else 0.5, 7.0, (), 0.1, 0.08, Gain(0.2, 0.1, 0.3), None)
        for name, score, sure in [("viscous_asymmetry", 20.0, True), *listed]
    ]
    found = lab.Diagnosis("missing", "", 0.001, [("viscous_asymmetry",)], candidates)
    told = _ranking(None, found, {"viscous_asymmetry"}, "viscous_asymmetry")
    assert [(one.effect, one.why_not) for one in told] == [
        ("viscous_asymmetry", []),
        ("spring", ["viscous_asymmetry first"]),
        ("coulomb_asymmetry", ["viscous_asymmetry first"]),
        ("cogging", ["may be luck (p = 0.5)"]),
        ("stribeck", ["may be luck (p = 0.5)"]),
    ]
    assert "not named: viscous_asymmetry first" in told[1].sentence


def test_the_numbers_of_all_answers_agree(story, study):
    base, better, again = story["ladder"].rungs
    for rung, compared in ((base, story["compare"]), (better, story["compare after"])):
        assert rung.training == pytest.approx(compared.error.training.relative, rel=1e-9)
        assert rung.held_out == pytest.approx(compared.error.held_out.relative, rel=1e-9)
        assert rung.held_out_kind == compared.error.held_out.kind == "hold-out"
        assert rung.held_out_low < rung.held_out < rung.held_out_high
    added, best = story["add"], story["diagnose"].ranking[0]
    for change, rung in ((added.before, base), (added.after, better)):
        assert (change.training, change.held_out) == pytest.approx((rung.training, rung.held_out), rel=1e-9)
    assert added.gain == pytest.approx(1 - better.held_out / base.held_out, abs=0.05)  # rows count by their scatter
    assert best.held_out_before == pytest.approx(base.held_out, rel=1e-9)
    assert best.held_out_after == pytest.approx(better.held_out, rel=1e-6)
    assert again.held_out == pytest.approx(base.held_out, rel=1e-6)
    assert story["ladder"].floor == pytest.approx(story["compare after"].error.floor.relative, rel=1e-9)
    assert [rung.added for rung in (base, better, again)] == [None, "viscous_asymmetry", None]
    assert [rung.removed for rung in (base, better, again)] == [None, None, "viscous_asymmetry"]
    assert [rung.parent_id for rung in (base, better, again)] == [None, base.model_id, better.model_id]
    assert base.model_id == study.model_id
    assert story["ladder"].floor < better.held_out * 1.2
    assert better.held_out < base.held_out


def test_errors_are_those_of_the_series(store, experiment_id):
    study = create_study(store, "all rows", [experiment_id], hold_out=["repeat=2"], cutoff_hz=6.0, rows="all")
    found = compare(store, study.study_id)
    powers = {"training": np.zeros(3), "held_out": np.zeros(3)}
    for series, trial in zip(found.series, found.trials, strict=True):
        measured, predicted, residual = map(np.array, (series.measured, series.predicted, series.residual))
        assert series.trial_id == trial.trial_id
        assert len(series.time_s) == len(measured)
        assert (np.diff(series.time_s) > 0).all()
        assert measured - predicted == pytest.approx(residual, abs=1e-12)
        assert trial.rms == pytest.approx(np.sqrt(np.mean(residual**2)), rel=1e-9)
        assert trial.relative == pytest.approx(np.linalg.norm(residual) / np.linalg.norm(measured), rel=1e-9)
        powers[trial.role] += [residual @ residual, measured @ measured, len(measured)]
    for role, (residual, effort, count) in powers.items():
        error = found.error.training if role == "training" else found.error.held_out
        assert error.relative == pytest.approx(np.sqrt(residual / effort), rel=1e-9)
        assert error.rms == pytest.approx(np.sqrt(residual / count), rel=1e-9)


def test_held_out_alone_counts_as_held_out(story):
    names = {trial.name: trial.role for trial in story["compare"].trials}
    assert all(role == ("held_out" if name.endswith("-2") else "training") for name, role in names.items())


@pytest.mark.parametrize("answer", ["compare", "compare after", "diagnose", "diagnose after", "add", "drop", "ladder"])
def test_answers_come_back_from_json_as_they_were(story, answer):
    found = story[answer]
    text = found.model_dump_json()
    assert type(found).model_validate_json(text).model_dump_json() == text


def test_json_has_no_nan(store, story, study, capsys):
    def numbers(value):
        if isinstance(value, dict):
            value = list(value.values())
        if isinstance(value, list):
            for one in value:
                yield from numbers(one)
        elif isinstance(value, float):
            yield value

    for answer in [*story.values(), study, effects_catalogue()]:
        print_json(answer)
        out = capsys.readouterr().out
        assert "NaN" not in out
        assert all(math.isfinite(one) for one in numbers(json.loads(out)))
    assert describe(store, study.study_id).trials == study.trials


def test_pictures_and_residuals_are_drawable(story):
    for one in story["diagnose"].ranking:
        picture = one.picture
        lengths = {len(values) for values in (picture.x, picture.residual, picture.low, picture.high)}
        assert len(lengths) == 1
        assert lengths.pop() > 3 or picture.driver == "load at the tip"
        assert len(picture.curve_x) == len(picture.curve)
    for against in story["compare"].residual_against:
        for group in against.groups:
            assert len({len(one) for one in (group.x, group.mean, group.low, group.high, group.count)}) == 1


def test_effort_over_time_does_not_fall_where_steady_sliding_ends(store, study, story):
    """Rows in steady sliding are judged on what their filter sees of it; a plot over time shows all."""
    whole = load(store, study.study_id).dataset.seen_by("moving")
    shown = np.concatenate([one.measured for one in story["compare"].series])
    assert shown == pytest.approx(whole.effort, rel=1e-6, abs=1e-9)


def test_parameters_have_units_and_intervals(story):
    found = {(one.effect, one.name): one for one in story["compare after"].parameters}
    viscous = found["viscous", "viscous friction"]
    assert viscous.unit == "N m s/rad"
    assert viscous.low < viscous.value < viscous.high
    assert viscous.value == pytest.approx(0.03, rel=0.03)
    assert found["viscous_asymmetry", "half difference of viscous friction"].value == pytest.approx(0.012, rel=0.1)


def test_without_held_out_trials_each_is_left_out_in_turn(store, experiment_id):
    study = create_study(store, "joint", [experiment_id], where=["repeat=1"], cutoff_hz=6.0)
    found = compare(store, study.study_id)
    assert found.error.held_out.kind == "leave-one-trial-out"
    assert found.error.floor is None
    assert any("No trial repeats another" in note for note in found.notes)
    assert ladder(store, study.study_id).floor is None


def test_few_trials_leave_out_stretches_and_say_so(store):
    number = imported(store, plans(loads_kg=(0.2,)))
    study = create_study(store, "joint", [number], cutoff_hz=6.0)
    found = compare(store, study.study_id)
    assert found.error.held_out.kind == "leave-one-block-out"
    assert any("stretches of 2 s are left out instead" in note for note in found.notes)


def test_what_does_not_exist_is_told(store, study):
    number = study.study_id
    with pytest.raises(StudyError, match="effect 'magic' is not in the catalogue"):
        add_effect(store, number, "magic")
    with pytest.raises(StudyError, match=r"model \d+ has viscous already; its effects are: inertia"):
        add_effect(store, number, "viscous", study.model_id)
    with pytest.raises(StudyError, match=r"model \d+ has no spring; its effects are: inertia"):
        drop_effect(store, number, "spring", study.model_id)
    for ask in (compare, diagnose, ladder, describe):
        with pytest.raises(NotFoundError, match="99999"):
            ask(store, 99999)
    for ask in (compare, diagnose):
        with pytest.raises(StudyError, match=f"study {number} has no model 99999; its models are: {study.model_id}"):
            ask(store, number, 99999)
    before = len(store.models(number))
    with pytest.raises(StudyError, match="has no model 99999"):
        add_effect(store, number, "spring", 99999)
    assert len(store.models(number)) == before


def test_an_effect_that_the_trials_cannot_show_is_refused(store):
    number = imported(store, plans(loads_kg=(0.2,), temperatures_c=(30.0,)))
    study = create_study(store, "joint", [number], cutoff_hz=6.0)
    with pytest.raises(StudyError, match="weight_friction needs load_kg to differ over the data, and it does not"):
        add_effect(store, study.study_id, "weight_friction")
    found = diagnose(store, study.study_id)
    told = {one.values["effect"]: one for one in found.findings if one.code == "not-judged"}
    assert told["viscous_temperature"].text in found.notes
    notes = found.notes
    assert any("Not judged: viscous_temperature needs temperature_c to differ" in note for note in notes)
    assert len(store.models(study.study_id)) == 1


def test_a_model_is_fitted_again_as_it_was(store, story, study):
    again = compare(store, study.study_id, study.model_id)
    assert again.model_dump_json() == story["compare"].model_dump_json()


def test_a_model_keeps_the_shapes_it_was_fitted_at(store, study):
    model = store.model(study.model_id)
    result = {**model.result, "shapes": {**model.result["shapes"], "stribeck": [0.5, 1.5]}}
    other = store.add_model(study.study_id, model.id, model.effects, result)
    found = {one.name: one.value for one in compare(store, study.study_id, other).parameters}
    assert (found["Stribeck speed"], found["Stribeck exponent"]) == (0.5, 1.5)
    store.remove_model(other)


def test_the_last_effect_cannot_be_dropped(store, experiment_id):
    study = create_study(store, "joint", [experiment_id], base=["gravity"], cutoff_hz=6.0)
    with pytest.raises(StudyError, match="the model has no effects; add at least one"):
        drop_effect(store, study.study_id, "gravity")


def test_an_unknown_effect_names_its_driver(store):
    # a quarter of dry friction: one as large as that is most of what the noise is learnt from, and hides its own way
    bump = Joint(extra=lambda x: 0.02 * np.exp(-(((x.q - 0.4) / 0.08) ** 2)) * np.sign(x.v))
    study = create_study(store, "joint", [imported(store, plans(), bump)])
    found = diagnose(store, study.study_id)
    assert found.verdict == "unknown-effect"
    assert "position against motion" in found.sentence
    assert found.classes == []


def test_the_catalogue_as_json():
    found = {one.name: one for one in effects_catalogue()}
    (share,) = found["load_friction"].parameters
    assert (share.name, share.unit, share.low, share.high) == ("share of the load lost", "1", 0.0, 1.0)
    assert found["gravity"].parameters[0].low is None
    assert found["viscous_temperature"].channels == ["temperature_c"]


def test_a_search_keeps_every_model_on_its_way(store, experiment_id):
    number = create_study(store, "searched", [experiment_id], hold_out=["repeat=2"], cutoff_hz=6.0).study_id
    found = search(store, number)
    assert found.added == ["viscous_asymmetry"]
    assert found.verdict == "nothing"
    base, better = ladder(store, number).rungs
    (step,) = found.steps
    assert (step.change, step.effect) == ("add", "viscous_asymmetry")
    assert step.model_id == better.model_id == found.model_id
    assert (step.before, step.after) == pytest.approx((base.held_out, better.held_out))
    assert step.sentence.startswith("Added viscous_asymmetry: held-out error ")
    assert base.gain is None
    assert (better.gain.rows, better.shows) == ("steady sliding", "")
    assert better.gain.held_out_before == pytest.approx(base.held_out, rel=0.01)
    assert better.gain.gain_low < better.gain.gain < better.gain.gain_high


def test_an_effect_with_memory_is_judged_where_it_lives_and_the_ladder_where_the_study_looks(store):
    from tests.lab.diagnosis.test_diagnose import WITH_MEMORY

    joint = Joint(extra=WITH_MEMORY["pre_sliding"])
    number = create_study(store, "memory", [imported(store, plans((0.0, 0.2)), joint)], cutoff_hz=6.0).study_id
    change = add_effect(store, number, "pre_sliding")
    assert change.gain_low > 0.5  # near reversals
    regimes = {one.name: one.relative for one in compare(store, number).regimes}
    before = {one.name: one.relative for one in compare(store, number, change.parent_id).regimes}
    assert regimes["transient"] < 0.5 * before["transient"]
    rungs = ladder(store, number).rungs
    assert rungs[1].held_out < rungs[0].held_out < change.before.held_out
    kept = rungs[1].gain
    assert (rungs[1].shows, kept.rows, kept.gain_low) == ("near reversals", change.rows, change.gain_low)
    assert (kept.held_out_before, kept.held_out_after) == (change.before.held_out, change.after.held_out)


@pytest.mark.parametrize(("after", "told"), [(0.23, True), (0.0315, False)])
def test_a_gain_unlike_the_errors_beside_it_says_why(after, told):
    sentence = _sentence("Adding", "spring", "held-out error", 0.21, after, Gain(0.85, 0.8, 0.9))
    assert ("each row counting by how well it is known" in sentence) == told


@pytest.mark.parametrize(
    ("gain", "after", "told"),
    [
        (Gain(-0.676, -0.8, -0.5), 0.0785, "Dropping it harms: add it again."),
        (Gain(0.0, -0.1, 0.1), 0.0785, "dropping it does no harm that these trials show."),
        (Gain(0.2, 0.1, 0.3), 0.0375, "Dropping it helps: the model is better without it."),
        (Gain(0.001, 0.0004, 0.0014), 0.0785, "that matters, being under 0.5%: the model is as good without it."),
        (Gain(-0.0049, -0.02, -0.001), 0.0785, "that matters, being under 0.5%: the model is as good without it."),
    ],
)
def test_what_is_said_after_an_effect_was_dropped_is_about_dropping_it(gain, after, told):
    assert _sentence("Dropping", "elasticity", "held-out error", 0.0468, after, gain).endswith(told)


@pytest.mark.parametrize(("gain", "after", "way"), [(0.2, 0.0785, "for"), (-0.2, 0.0375, "against")])
@pytest.mark.parametrize("done", ["Adding", "Dropping"])
def test_a_gain_that_the_error_speaks_against_is_no_advice(done, gain, after, way):
    """Rows that no other trial tells of may fill the plain error, and hardly count in the gain: neither is hidden."""
    sentence = _sentence(done, "spring", "held-out error", 0.0468, after, Gain(gain, gain - 0.1, gain + 0.1))
    assert f"The two disagree: the gain, by which a diagnosis judges, speaks {way} it, and the error" in sentence
    assert sentence.endswith("`study compare` of both models shows in which trials.")


@pytest.mark.parametrize(
    ("gain", "told"),
    [
        (Gain(-0.0002, -0.0004, -0.0001), "That is no difference that is worth it, being under 0.5%: leave it out."),
        (Gain(0.001, 0.0005, 0.006), "That is no difference that is worth it, being under 0.5%: leave it out."),
        (Gain(0.0, -0.001, 0.001), "That is no difference that is worth it, being under 0.5%: leave it out."),
        (Gain(0.001, -0.1, 0.1), "these trials do not show that it is needed."),
        (Gain(0.006, 0.005, 0.007), "It helps: keep it."),
    ],
)
def test_a_gain_of_next_to_nothing_is_called_so_however_sure(gain, told):
    assert _sentence("Adding", "elasticity", "held-out error", 0.0031, 0.0031, gain).endswith(told)


@pytest.mark.parametrize(
    ("left_out", "sentence"),
    [
        ({"back_driving_friction": "why"}, "Load-dependent friction stands alone among what these trials can judge."),
        ({"backlash": "why"}, "Load-dependent friction stands alone."),
    ],
)
def test_beside_a_hidden_rival_a_name_stands_alone_among_what_can_be_judged(store, study, left_out, sentence):
    material, model = load_model(store, study.study_id, study.model_id)
    fit = material.fit_of(model)
    assert "gravity" in fit.names
    found = diagnosis_of_model(material, model, fit)
    first = replace(found.candidates[0], effect=effect_named("load_friction"))
    told = replace(found, classes=[("load_friction",)], candidates=[first], left_out=left_out)
    assert [one.sentence for one in answer_of(fit, told, 1, model.id).classes] == [sentence]
