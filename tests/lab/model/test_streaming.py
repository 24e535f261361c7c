"""Streamed normal equations: the same numbers as with all rows in memory, and memory that does not grow."""

import tracemalloc

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.errors import UnusableDataError
from compensator.lab.model import streaming
from compensator.lab.model.fit import fit_model
from compensator.lab.model.held_out_error import relative_error
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.model.streaming import fit_streamed, pieces
from compensator.lab.model.validation import held_out
from compensator.lab.rows.assembly import make_dataset, more_trials
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, plans, record, recordings

EFFECTS = default_effects(FACTS)


@pytest.fixture(scope="module")
def trials():
    return recordings(Joint(), trials=plans(), seed=5)


@pytest.fixture(scope="module")
def fit(trials):
    return fit_model(make_dataset(trials, FACTS, Processing()), EFFECTS)


def test_the_same_trials_give_the_same_model_and_errors(fit, trials):
    found = fit_streamed(fit, iter(trials))
    assert found.coefficients == pytest.approx(fit.coefficients, rel=1e-6, abs=1e-9)
    assert found.rows == int(fit.training.sum())
    assert found.samples == sum(len(trial) for trial in trials)
    inside = relative_error(fit.residual[fit.training], fit.dataset.effort[fit.training])
    assert found.training == pytest.approx(inside, rel=1e-6)
    assert found.held_out == pytest.approx(held_out(fit).relative, rel=1e-6)
    assert found.skipped == {}


def test_terms_of_the_predicted_load_are_built_from_the_load_of_the_fit(trials):
    fit = fit_model(make_dataset(trials, FACTS, Processing()), [*EFFECTS, "load_friction"])
    assert fit_streamed(fit, trials).coefficients == pytest.approx(fit.coefficients, rel=1e-4, abs=1e-6)


def test_columns_that_go_by_the_largest_effort_are_those_of_all_trials(trials):
    """A trial of little effort alone would have a dead time, or a sagging supply, of another size."""
    fit = fit_model(make_dataset(trials, FACTS, Processing()), [*EFFECTS, "load_friction"])
    whole = with_own_prediction(fit.dataset, fit.terms)
    alone = with_own_prediction(more_trials(fit.dataset, trials[:1]), fit.terms)
    dead_time = effect_named("dead_time")
    (shape, *_) = dead_time.shapes(whole.trials[0].motion)[-1:]
    among, single = (dead_time.columns(one.trials[0].motion, shape) for one in (whole, alone))
    assert np.abs(alone.trials[0].motion.predicted).max() < 0.7 * whole.trials[0].motion.largest_effort
    assert single == pytest.approx(among, abs=0.01)


def test_a_long_trial_in_pieces_loses_no_row(fit, monkeypatch):
    long = record(plans()[1], Joint(), Bench(duration_s=120.0), np.random.default_rng(6))
    whole = fit_streamed(fit, [long])
    monkeypatch.setattr(streaming, "PIECE_ROWS", 4000)
    cut = list(pieces(long, fit.dataset.cutoff_hz))
    assert len(cut) > 5
    assert max(map(len, cut)) == 4000
    assert cut[1].conditions["session_s"] == pytest.approx(cut[1].channels["time_s"][0])
    found = fit_streamed(fit, [long])
    assert found.rows == pytest.approx(whole.rows, rel=0.01)
    assert found.coefficients == pytest.approx(whole.coefficients, rel=0.02, abs=1e-3)


def test_memory_does_not_grow_with_the_number_of_trials(fit):
    plan, random = plans()[0], np.random.default_rng(7)

    def peak_bytes(count: int) -> int:
        made = (record(Plan(f"trial {i}", plan.sines), Joint(), Bench(), random) for i in range(count))
        tracemalloc.start()
        fit_streamed(fit, made)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    peak_bytes(2)
    few, many = peak_bytes(4), peak_bytes(40)
    one_recording = 8 * 2400 * 4  # less than a tenth of what 36 more of them would take
    assert many - few < 3 * one_recording


def test_a_recording_that_cannot_be_used_is_named_and_left_out(fit, trials):
    short = record(Plan("short", [(1.0, 0.3, 0.0)]), Joint(), Bench(duration_s=0.3), np.random.default_rng(1))
    found = fit_streamed(fit, [*trials, short])
    assert "record longer" in found.skipped["short"]
    with pytest.raises(UnusableDataError, match="record longer"):
        fit_streamed(fit, [short])
