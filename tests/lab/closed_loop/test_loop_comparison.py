"""Errors of motion and effort in closed loop, and coefficients refined by them."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.closed_loop import refinement
from compensator.lab.closed_loop.loop_comparison import compare_in_loop
from compensator.lab.closed_loop.refinement import refine
from compensator.lab.closed_loop.simulation import simulate
from compensator.lab.model.fit import fit_model, with_coefficients
from compensator.lab.model.fitted import Fit
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.closed_loop.servoed import FACTS, Joint, recordings

MODEL = ["inertia", "gravity", "coulomb", "viscous"]


@pytest.fixture(scope="module")
def fit() -> Fit:
    return fit_model(make_dataset(recordings(Joint(), 5), FACTS, Processing()), MODEL)


def test_errors_are_those_of_the_simulated_motion(fit):
    compared = compare_in_loop(fit)
    trial, told = fit.dataset.trials[1], compared.trials[1]
    run = simulate(fit, trial)
    off = (run.position - trial.signals.position)[run.closed]
    assert told.error.position == pytest.approx(np.sqrt(np.mean(off**2)))
    assert told.error.position_relative == pytest.approx(
        np.sqrt(np.mean(off**2)) / np.std(trial.signals.position[run.closed])
    )
    assert (told.name, told.held_out, told.source) == ("trial-1", False, "recording")
    assert compared.training.samples == sum(one.error.samples for one in compared.trials)


def test_a_missing_effect_shows_in_the_motion():
    joint = Joint(coulomb=0.02, viscous=0.4)
    dataset = make_dataset(recordings(joint, 5), FACTS, Processing())
    errors = [compare_in_loop(fit_model(dataset, MODEL[:end])).held_out for end in (3, 4)]
    assert errors[1].position < 0.2 * errors[0].position
    assert errors[1].effort_relative < 0.2 * errors[0].effort_relative


def test_trials_that_were_held_out_are_judged_by_themselves(fit):
    inside = fit.dataset.counted & (fit.dataset.trial_index != 4)
    compared = compare_in_loop(fit_model(fit.dataset, MODEL, inside))
    assert [one.held_out for one in compared.trials] == [False] * 4 + [True]
    assert compared.held_out == compared.trials[4].error


def test_each_trial_in_turn_is_unknown_to_the_coefficients(fit):
    """One trial of another joint: its own error is larger where it was left out of the fit."""
    odd = recordings(Joint(coulomb=0.5), 5)[4]
    mixed = fit_model(make_dataset([*recordings(Joint(), 4), odd], FACTS, Processing()), MODEL)
    compared = compare_in_loop(mixed)
    assert compared.held_out is not None
    assert compared.held_out.effort > 1.05 * compared.training.effort


def test_a_trial_that_was_never_fitted_is_judged_too(fit):
    """Errors held out and of training are of the same trials, though one holds no row that counts."""
    trials = tuple(_without_rows(trial, index == 2) for index, trial in enumerate(fit.dataset.trials))
    compared = compare_in_loop(fit_model(replace(fit.dataset, trials=trials, cache={}), MODEL))
    assert compared.held_out is not None
    assert compared.held_out.samples == compared.training.samples


def _without_rows(trial, wanted):
    return replace(trial, picked=trial.picked[:0]) if wanted else trial


def test_too_few_trials_are_not_held_out():
    dataset = make_dataset(recordings(Joint(), 2), FACTS, Processing())
    assert compare_in_loop(fit_model(dataset, MODEL)).held_out is None


def test_effects_of_the_measuring_chain_move_nothing(fit):
    late = fit_model(fit.dataset, [*MODEL, "measurement_delay"])
    coefficients = np.append(late.coefficients[:-1], 0.05)
    compared = compare_in_loop(with_coefficients(late, coefficients))
    assert compared.left_out == ("measurement_delay",)
    plain = compare_in_loop(with_coefficients(fit, late.coefficients[:-1]))
    assert compared.training.position == pytest.approx(plain.training.position, rel=1e-6)


def test_refinement_comes_back_to_the_truth():
    """What an encoder's counts hide from columns along the measured motion, those along the simulated one have."""
    rough = fit_model(make_dataset(recordings(Joint(count_rad=0.005), 5), FACTS, Processing(cutoff_hz=20.0)), MODEL)
    refined = refine(rough)
    assert refined.fit is not None
    truth = np.array([0.05, 0.0, 0.6, 0.0, 0.2, 0.1])
    before, after = (np.abs(one.coefficients - truth).sum() for one in (rough, refined.fit))
    assert after < 0.5 * before
    assert refined.after.training.effort < 0.8 * refined.before.training.effort


def test_where_nothing_is_gained_the_model_stays(fit):
    """Along the very motion that a model makes there is nothing to be learnt that it does not know."""
    refined = refine(fit)
    assert refined.after.training.effort <= refined.before.training.effort
    if refined.fit is None:
        assert refined.after is refined.before
    else:
        assert refined.fit.coefficients == pytest.approx(fit.coefficients, rel=0.05, abs=0.01)


def test_a_pass_that_finds_a_model_of_no_inertia_ends_it_with_the_best_so_far(fit, monkeypatch):
    along = refinement._along(fit, compare_in_loop(fit))
    still = with_coefficients(along, np.where(np.arange(len(along.coefficients)) < 2, 0.0, along.coefficients))
    assert fit.names[0] == "inertia"
    monkeypatch.setattr(refinement, "_along", lambda *_: still)
    found = refine(fit)
    assert (found.fit, found.passes) == (None, 1)
