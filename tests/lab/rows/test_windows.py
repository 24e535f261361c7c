"""What the filter of a row sees: nothing of a joint that stands, whose effort may be any."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model, over_time, seeing_all
from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, recordings

STROKES = [Plan(f"strokes-{n}", [(0.9, 0.25, n), (0.3, 0.4, 2.0 * n)], load_kg=0.1 * n) for n in range(3)]


def dataset(made: list[Recording]) -> Dataset:
    return make_dataset(made, FACTS, Processing(cutoff_hz=6.0))


def test_an_effort_of_a_joint_that_stands_moves_no_row_in_steady_sliding():
    made = recordings(trials=STROKES, seed=2)
    plain = dataset(made)
    stuck = [trial.regimes == Regime.STUCK for trial in plain.trials]
    assert all(one.any() for one in stuck)
    pushed = [
        replace(one, channels={**one.channels, "torque_n_m": one.channels["torque_n_m"] + 5.0 * stands})
        for one, stands in zip(made, stuck, strict=True)
    ]
    found = dataset(pushed)
    moved = np.abs(found.effort - plain.effort)
    assert moved[plain.regime == Regime.STUCK].max() > 1.0
    assert moved[plain.regime == Regime.SLIDING].max() < 1e-9
    whole = np.abs(found.seen_by("moving").effort - plain.seen_by("moving").effort)
    assert whole[plain.regime == Regime.SLIDING].max() > 0.1
    assert whole[plain.regime != Regime.SLIDING] == pytest.approx(moved[plain.regime != Regime.SLIDING])


def test_a_row_beside_a_stop_sees_as_much_of_white_noise_as_is_said():
    plain, draws = dataset(recordings(trials=STROKES, seed=2)), 400
    random = np.random.default_rng(3)
    noise = [random.standard_normal((draws, len(trial.window))) for trial in plain.trials]
    sliding, whole = plain.regime == Regime.SLIDING, plain.seen_by("moving")
    usual = np.sqrt(np.mean(whole.stack(noise)[sliding] ** 2))
    measured = np.sqrt(np.mean(plain.stack(noise)[sliding] ** 2, axis=1)) / usual
    assert plain.noise_seen[sliding].min() < 0.6
    assert plain.noise_seen[sliding] == pytest.approx(measured, abs=0.15)
    assert (whole.noise_seen == 1.0).all()


def test_rows_that_are_all_counted_see_all():
    made = recordings(trials=STROKES, seed=2)
    every = make_dataset(made, FACTS, Processing(cutoff_hz=6.0, rows="all"))
    assert every.effort == pytest.approx(dataset(made).seen_by("all").effort)
    assert every.seen_by("moving") is every


def test_a_model_of_rows_that_see_all_has_the_same_rows_and_shapes():
    fit = fit_model(dataset(recordings(trials=STROKES, seed=2)), default_effects(FACTS))
    whole = seeing_all(fit)
    assert whole.dataset.sees_all
    assert (whole.training == fit.training).all()
    assert whole.shapes == fit.shapes
    assert whole.coefficients != pytest.approx(fit.coefficients)
    assert seeing_all(whole) is whole


def test_over_time_effort_does_not_fall_where_steady_sliding_ends():
    fit = fit_model(dataset(recordings(trials=STROKES, seed=2)), default_effects(FACTS))
    shown = over_time(fit)
    assert shown.coefficients == pytest.approx(fit.coefficients)
    assert shown.dataset.effort == pytest.approx(fit.dataset.seen_by("moving").effort)
    last = np.flatnonzero((fit.dataset.regime[:-1] == Regime.SLIDING) & (fit.dataset.regime[1:] == Regime.TRANSIENT))
    assert len(last) > 3
    jumps = [np.median(np.abs(one.dataset.effort[last + 1] - one.dataset.effort[last])) for one in (fit, shown)]
    assert jumps[1] < 0.5 * jumps[0]


def test_a_view_of_a_view_is_the_first_again():
    plain = dataset(recordings(trials=STROKES, seed=2))
    assert plain.seen_by("sliding") is plain
    again = plain.seen_by("moving").seen_by("sliding")
    assert again.effort == pytest.approx(plain.effort)


def test_a_model_that_is_right_leaves_next_to_nothing_beside_stops():
    """Of what the filter carried over from stops it would leave some hundred times as much."""
    made = recordings(Joint(), Bench(noise=0.0, quantum=0.0), STROKES)
    fit = fit_model(dataset(made), default_effects(FACTS), shapes={"stribeck": (0.25, 1.0)})
    inside = fit.training
    assert np.std(fit.residual[inside]) < 2e-5 * np.std(fit.dataset.effort[inside])
