"""Held-out errors, against refitting by brute force."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import HeldOut, on_even_terms, relative_error, rms
from compensator.lab.model.validation import held_out, independent_units
from compensator.lab.model.weights import weights_of
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, plans, recordings

DEFAULT = default_effects(FACTS)


@pytest.fixture(scope="module")
def fit() -> Fit:
    return fit_model(make_dataset(recordings(Joint(viscous=-0.001), seed=8), FACTS, Processing()), DEFAULT)


def brute_force(fit: Fit, units: np.ndarray) -> np.ndarray:
    """Residual of every training row under a model refitted without its unit, shapes as they are."""
    residual = np.full(len(fit.dataset.effort), np.nan)
    for unit in np.unique(units[fit.training]):
        own = fit.training & (units == unit)
        rest = fit_model(fit.dataset, fit.names, fit.training & ~own, fit.shapes)
        residual[own] = rest.residual[own]
    return residual[fit.training]


def test_leaving_one_trial_out_is_refitting_without_it(fit):
    found = held_out(fit)
    assert found.kind == "leave-one-trial-out"
    wanted = brute_force(fit, fit.dataset.trial_index)
    assert found.residual == pytest.approx(wanted, abs=1e-7)
    assert found.rms == pytest.approx(np.sqrt(np.mean(wanted**2)))
    effort = fit.dataset.effort[fit.training]
    assert found.relative == pytest.approx(np.linalg.norm(wanted) / np.linalg.norm(effort))
    assert found.rms > rms(fit.residual[fit.training])


def test_the_doubt_of_a_trial_is_what_the_others_leave_open_of_its_prediction(fit):
    found = held_out(fit)
    columns = fit.weight[:, None] * fit.columns[:, np.concatenate([term.kept for term in fit.terms])]
    for trial in (0, 7):
        own = fit.training & (fit.dataset.trial_index == trial)
        rest = columns[fit.training & ~own]
        wanted = np.einsum("ij,jk,ik->i", columns[own], np.linalg.inv(rest.T @ rest), columns[own])
        weight = weights_of(fit, own, found.residual[found.unit == trial]) / np.sqrt(1.0 + wanted)
        assert found.weight[found.unit == trial] == pytest.approx(weight, rel=1e-6)


def test_the_only_trial_without_load_counts_little_and_one_that_is_repeated_as_it_is():
    alone = [*plans((0.25,)), plans((0.0,))[0]]
    fit = fit_model(make_dataset(recordings(trials=alone, seed=8), FACTS, Processing()), DEFAULT)
    found = held_out(fit)
    counted, _ = on_even_terms(found, found)
    kept = np.sqrt(counted.power_by_unit() / found.power_by_unit())
    assert kept[-1] < 0.5
    assert np.mean(kept[:-1]) == pytest.approx(1.0, abs=0.1)


def test_held_out_trials_judge_the_fit_they_were_not_in(fit):
    training = fit.dataset.counted & (fit.dataset.trial_index < 6)
    inside = fit_model(fit.dataset, DEFAULT, training)
    found = held_out(inside)
    assert found.kind == "hold-out"
    assert not (found.rows & training).any()
    assert (found.rows | training == fit.dataset.counted).all()
    assert found.residual == pytest.approx(inside.residual[found.rows])


def test_held_out_effort_never_reaches_the_fit(fit):
    training = fit.dataset.counted & (fit.dataset.trial_index < 6)
    before = fit_model(fit.dataset, DEFAULT, training)
    spoilt = replace(fit.dataset, cache={})
    spoilt.__dict__["effort"] = np.where(training, fit.dataset.effort, -5.0)
    after = fit_model(spoilt, DEFAULT, training)
    assert after.coefficients == pytest.approx(before.coefficients, rel=1e-12)
    assert after.shapes == before.shapes
    assert held_out(after).rms > 1.0


def test_with_fewer_than_four_trials_stretches_are_left_out():
    few = recordings(trials=plans(loads_kg=(0.0,)), seed=3)
    fit = fit_model(make_dataset(few, FACTS, Processing()), DEFAULT)
    found = held_out(fit)
    assert found.kind == "leave-one-block-out"
    assert found.residual == pytest.approx(brute_force(fit, fit.dataset.block_index), abs=1e-7)
    assert len(found.power_by_unit()) == len(np.unique(fit.dataset.block_index[fit.training]))
    assert (independent_units(fit, fit.training) == fit.dataset.block_index[fit.training]).all()


def test_stretches_are_two_seconds_of_one_trial(fit):
    dataset = fit.dataset
    for block in np.unique(dataset.block_index):
        rows = dataset.block_index == block
        assert len(np.unique(dataset.trial_index[rows])) == 1
        trial = dataset.trials[dataset.trial_index[rows][0]]
        inside = rows[dataset.trial_index == dataset.trial_index[rows][0]]
        assert np.ptp(dataset.time_of(trial)[inside]) < 2.0


def test_power_by_unit_adds_up():
    unit = np.array([7, 7, 2, 9, 2])
    residual, effort = np.array([1.0, 2.0, 3.0, 4.0, 5.0]), np.ones(5)
    one = HeldOut("hold-out", np.ones(5, dtype=bool), residual, effort, unit, 0.0, 0.0)
    assert one.power_by_unit().tolist() == [34.0, 5.0, 16.0]
    assert one.effort_power_by_unit().tolist() == [2.0, 2.0, 1.0]


def test_relative_error_and_rms():
    assert relative_error(np.array([3.0, 4.0]), np.array([0.0, 10.0])) == pytest.approx(0.5)
    assert np.isnan(relative_error(np.ones(2), np.zeros(2)))
    assert rms(np.array([3.0, 4.0])) == pytest.approx(np.sqrt(12.5))
    assert np.isnan(rms(np.empty(0)))
