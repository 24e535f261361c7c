"""Predicted d', and the trials chosen by it."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_model
from compensator.lab.next_trial.confounded import shows_from_rest
from compensator.lab.next_trial.separation import Separation
from compensator.lab.next_trial.suggest import SURE, d_prime_of, suggest
from compensator.lab.next_trial.suggestion import Option
from compensator.lab.rows.assembly import make_dataset, more_trials
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather
from tests.lab.at_rest.test_breakaways import falling
from tests.lab.ramps import HORIZONTAL, MODEL, ramp_trial, swing
from tests.lab.synthetic import FACTS, G_M_S2, Bench, Joint, plans, recordings

BENCH = Bench(duration_s=9.0)
LIGHT, HEAVY = (0.1, 0.15), (0.0, 0.5)


def load_friction(share):
    def law(x):
        load = (0.25 + x.load_kg * G_M_S2 * x.arm_m) * np.sin(x.q) + x.load_kg * x.arm_m**2 * x.a
        return share * np.abs(load) * np.sign(x.v)

    return law


def fitted(joint, trials, seed=0):
    made = recordings(joint, BENCH, trials, seed)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


@pytest.fixture(scope="module")
def fit():
    return fitted(Joint(extra=load_friction(0.012)), plans(LIGHT))


@pytest.fixture(scope="module")
def diagnosis(fit):
    return diagnose(fit)


def options(loads_kg, minutes=0.5):
    made = recordings(Joint(), BENCH, plans(loads_kg, seed=7), seed=5)
    return [Option(one.name, minutes, (one,)) for one in made]


def separated(fit, diagnosis, names):
    found = {one.effect.name: one for one in diagnosis.candidates}
    return Separation(gather(fit), [found[name] for name in names])


def test_the_same_trials_again_add_as_much_as_they_told(fit, diagnosis):
    separation = Separation(gather(fit), diagnosis.candidates[:2])
    again = separation.of_trials(more_trials(fit.dataset, [t.signals.recording for t in fit.dataset.trials]))
    np.testing.assert_allclose(again.gram, separation.measured.gram, rtol=1e-6, atol=1e-9 * again.gram.max())
    for pair in ((0, 1), (1, 0), (0, None)):
        once, twice = separation.d_prime(again, *pair), separation.d_prime(separation.measured + again, *pair)
        assert twice == pytest.approx(np.sqrt(2.0) * once, rel=1e-3)


def test_what_is_predicted_is_what_a_longer_recording_shows(fit, diagnosis):
    names = ("load_friction", "load_friction_quadratic")
    separation = separated(fit, diagnosis, names)
    planned = options(HEAVY)
    brings = [separation.of_trials(more_trials(fit.dataset, option.recordings)) for option in planned]
    predicted = separation.d_prime(sum(brings, separation.measured), 0, 1)
    joint = Joint(extra=load_friction(0.012))
    both = recordings(joint, BENCH, plans(LIGHT), 0) + recordings(joint, BENCH, plans(HEAVY, seed=7), 6)
    longer = fit_model(make_dataset(both, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))
    observed = separated(longer, diagnose(longer), names)
    assert predicted == pytest.approx(observed.d_prime(observed.measured, 0, 1), rel=0.3)
    assert predicted > 2.0 * separation.d_prime(separation.measured, 0, 1)


def test_a_rival_absorbs_what_looks_like_it(fit, diagnosis):
    separation = separated(fit, diagnosis, ("load_friction", "load_friction_quadratic"))
    alone, against = (separation.d_prime(separation.measured, 0, rival) for rival in (None, 1))
    assert against < 0.6 * alone


def test_it_is_all_the_same_to_the_truth_whether_what_imitates_it_is_a_rival_already(fit, diagnosis):
    names = ("load_friction", "load_friction_quadratic")
    both = separated(fit, diagnosis, names)
    first, *_ = (one for one in diagnosis.candidates if one.effect.name == names[0])
    alone = Separation(gather(fit), [first], others=[names[1]])
    assert (both.suspects, alone.suspects) == (2, 1)
    assert alone.d_prime(alone.measured, 0, 1) == pytest.approx(both.d_prime(both.measured, 0, 1), rel=1e-6)


def test_effects_that_may_come_up_later_are_told_apart_from_the_rivals_too(fit, diagnosis):
    found = suggest(fit, diagnosis, options(HEAVY), most=1)
    named = set(diagnosis.named)
    unforeseen = [pair for pair in found.pairs if pair.rival not in named]
    assert {pair.true for pair in unforeseen} == named
    assert found.picks[0].after == pytest.approx(min(pair.after for pair in found.pairs))


def test_heavier_loads_are_chosen_where_friction_grows_with_the_load(fit, diagnosis):
    assert "load_friction" in diagnosis.classes[0]
    found = suggest(fit, diagnosis, [*options(LIGHT), *options(HEAVY)], most=2)
    assert found.picks[0].name.startswith("load-500g")
    smallest = [min(pair.before for pair in found.pairs), *(pick.after for pick in found.picks)]
    assert all(after > before for before, after in pairwise(smallest))
    assert found.picks[-1].after == pytest.approx(min(pair.after for pair in found.pairs))


def test_a_pick_tells_by_how_much_the_rivals_differ_in_it_given_what_is_known(fit, diagnosis):
    separation = separated(fit, diagnosis, ("load_friction", "load_friction_quadratic"))
    known, brings = separation.measured, separation.of_trials(more_trials(fit.dataset, options(HEAVY)[0].recordings))
    pairs = ((0, 1), (0, None))
    rises = [separation.remaining(known + brings, *pair) - separation.remaining(known, *pair) for pair in pairs]
    differences = [separation.difference(known, brings, *pair) for pair in pairs]
    assert 0.0 < differences[0] < differences[1]  # the rival takes up some of what nothing would leave
    np.testing.assert_allclose(np.square(differences) * brings.rows, rises, rtol=1e-6)


def test_of_equal_trials_the_shorter_is_chosen(fit, diagnosis):
    heavy = options(HEAVY)
    slow = [replace(one, name=f"slow {one.name}", minutes=5.0) for one in heavy]
    found = suggest(fit, diagnosis, [*slow, *heavy], most=2)
    assert not any(pick.name.startswith("slow") for pick in found.picks)


def test_what_would_show_the_very_same_again_is_chosen_once(fit, diagnosis):
    one = options(HEAVY)[4]
    again = suggest(fit, diagnosis, [one], most=3)
    assert [pick.name for pick in again.picks] == [one.name] * len(again.picks)
    assert len(again.picks) > 1
    assert [pick.name for pick in suggest(fit, diagnosis, [replace(one, once=True)], most=3).picks] == [one.name]


def test_nothing_is_suggested_once_a_name_is_sure():
    sure = fitted(Joint(extra=lambda x: 0.05 * np.abs(x.v)), plans())
    diagnosis = diagnose(sure)
    found = suggest(sure, diagnosis, options(HEAVY))
    assert diagnosis.classes[0] == ("viscous_asymmetry",)
    assert min(pair.before for pair in found.pairs) > SURE
    assert found.picks == ()


def test_what_is_promised_is_less_than_predicted_and_nothing_where_the_evidence_may_be_chance(fit, diagnosis):
    sure = suggest(fit, diagnosis, options(HEAVY), most=2).pairs
    assert all(0.5 * pair.after < pair.promised < pair.after for pair in sure)
    complete = fitted(Joint(), plans(LIGHT))
    unsure = suggest(complete, diagnose(complete), options(HEAVY), most=2).pairs
    assert unsure
    assert all(pair.promised == 0.0 < pair.after for pair in unsure)


def test_rivals_that_no_trial_separates_are_named(fit, diagnosis):
    tiny = [replace(one, recordings=()) for one in options((0.0,))]
    found = suggest(fit, diagnosis, [one for one in tiny if one.recordings] or [], most=3)
    assert found.picks == ()
    assert all(pair.reachable == pytest.approx(pair.before) for pair in (*found.pairs, *found.hopeless))
    assert all(pair.before < 2.0 for pair in found.hopeless)


def test_without_a_ranking_there_is_nothing_to_separate(fit, diagnosis):
    with pytest.raises(UnusableDataError, match="ranks no effect"):
        suggest(fit, replace(diagnosis, candidates=[], classes=[], verdict="nothing"), [])


IN_STEP = ((0.3, 0.5), (1.5, 0.15), (6.0, 0.05))  # rest [s] and rate [N m/s]: the longer the one, the slower the other


@pytest.fixture(scope="module")
def ramps_in_step():
    """Ramps of which nobody can say whether rest or rate did it, and a maker of more."""
    random = np.random.default_rng(5)

    def ramp(name, dwell_s, rate):
        scatter = 1.0 + 0.01 * random.standard_normal()
        return ramp_trial(name, dwell_s, rate, lambda rest_s, r: scatter * falling(rest_s, r), random)[0]

    made = [swing(f"swing-{hz}", hz, random) for hz in (0.15, 0.3, 0.5, 0.7)]
    made += [ramp(f"ramp-{rate}-{repeat}", dwell_s, rate) for repeat in range(6) for dwell_s, rate in IN_STEP]
    return (
        fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL),
        ramp,
        swing("more", 0.4, random),
    )


@pytest.fixture(scope="module")
def found_in_step(ramps_in_step):
    return diagnose(ramps_in_step[0])


def test_a_slow_ramp_after_a_short_rest_tells_rate_from_dwell(ramps_in_step, found_in_step):
    (fit, ramp, more), found = ramps_in_step, found_in_step
    assert set(found.classes[0]) == {"rate_dependent_breakaway", "dwell_strengthening"}
    offered = {"swing": more, "in step": ramp("a", *IN_STEP[2]), "crossed": ramp("b", 0.3, 0.05)}
    suggested = suggest(fit, found, [Option(name, 1.0, (one,)) for name, one in offered.items()])
    assert suggested.picks[0].name == "crossed"
    assert all(pair.before < 5.0 and pair.after > SURE for pair in suggested.pairs)
    assert all(pair.before < pair.by_chance < pair.after for pair in suggested.pairs)


def test_where_nothing_is_sure_and_starts_alone_speak_for_an_effect_ramps_are_asked_for(found_in_step):
    found = found_in_step
    (best, *_) = from_rest = [one for one in found.candidates if one.rows == "breakaway"]
    assert best.score > 0.0
    assert best.physical
    steady = replace(best, rows="sliding", score=-1.0)

    def unsure(*candidates):
        return replace(found, verdict="nothing", classes=[(steady.effect.name,)], candidates=list(candidates))

    assert shows_from_rest(unsure(steady, *from_rest))
    most = max(one.score for one in from_rest)
    assert not shows_from_rest(unsure(replace(steady, score=most + 1.0), *from_rest))
    assert not shows_from_rest(unsure(steady, replace(best, impossible="it would be negative")))
    assert not shows_from_rest(replace(unsure(steady, *from_rest), verdict="missing"))


def test_predicted_d_prime_of_breakaway_comes_true(ramps_in_step, found_in_step):
    fit, ramp, _ = ramps_in_step
    suggested = suggest(fit, found_in_step, [Option("crossed", 1.0, (ramp("a", 0.3, 0.05),))])
    assert suggested.pairs
    recorded = [trial.signals.recording for trial in fit.dataset.trials] + [
        ramp(f"more-{n}", 0.3, 0.05) for n in (1, 2)
    ]
    last = diagnose(fit_model(make_dataset(recorded, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL))
    assert last.classes[0] == ("rate_dependent_breakaway",)


def test_an_option_may_be_suggested_more_often_than_there_are_options(fit, diagnosis):
    (one, *_) = options(LIGHT)
    suggested = suggest(fit, diagnosis, [one], most=3)
    assert [pick.name for pick in suggested.picks] == [one.name] * 3
    assert all(pair.by_chance == pytest.approx(pair.after) for pair in suggested.pairs)  # there is nothing else to draw


def test_a_rival_of_a_shape_that_is_not_scanned_is_separated_at_that_shape():
    """A diagnosis finds all shapes anew: none of them need be one of those that are scanned."""
    made = recordings(Joint(extra=lambda x: 0.02 * np.sin(5.3 * x.q)), seed=4)
    fit = fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS))
    found = diagnose(fit)
    between = replace(found.candidates[0], shape=(5.3,))
    assert between.effect.name == "cogging"
    assert (5.3,) not in between.effect.shapes(fit.dataset.trials[0].motion)
    assert Separation(gather(fit), [between]).rivals[0].shape == (5.3,)
    assert d_prime_of(fit, replace(found, candidates=[between]), "cogging") > SURE
