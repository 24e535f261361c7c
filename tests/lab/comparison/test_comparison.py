"""Measured against predicted: floor, regimes, bins."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.comparison.comparison import compare, repeatability_floor
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.effects.free_curve import FORCE, way_of
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.rows.drivers import available
from compensator.lab.rows.picture import binned_mean
from compensator.lab.screening.generic import free_curves, knots_of
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, plans, recordings

DEFAULT = default_effects(FACTS)


def fitted(trials: list[Plan], bench: Bench | None = None, joint: Joint | None = None, rows: str = "sliding") -> Fit:
    made = recordings(joint, bench, trials, seed=6)
    return fit_model(make_dataset(made, FACTS, Processing(8.0, rows)), DEFAULT)


@pytest.fixture(scope="module")
def repeated() -> Fit:
    return fitted(plans(loads_kg=(0.0, 0.2), repeats=2, temperatures_c=(25.0,)), Bench(noise_memory=0.0))


def test_the_floor_is_the_noise_of_one_trial(repeated):
    floor = repeatability_floor(repeated)
    in_band = 0.006 * np.sqrt(2 * 8.0 / 200.0)
    assert floor.rms == pytest.approx(in_band, rel=0.12)
    assert floor.relative == pytest.approx(floor.rms / np.sqrt(np.mean(repeated.dataset.effort**2)), rel=0.15)


def test_what_repeats_itself_is_not_in_the_floor(repeated):
    missing = Joint(extra=lambda x: 0.05 * np.cos(3 * x.q))
    trials = plans(loads_kg=(0.0, 0.2), repeats=2, temperatures_c=(25.0,))
    wrong = fitted(trials, Bench(noise_memory=0.0), missing)
    assert compare(wrong).training.rms > 3.0 * compare(repeated).training.rms
    assert repeatability_floor(wrong).rms == pytest.approx(repeatability_floor(repeated).rms, rel=0.05)


def test_friction_that_changes_from_run_to_run_is_in_the_floor():
    trials = plans(loads_kg=(0.0, 0.2), repeats=2, temperatures_c=(25.0,))
    made = recordings(bench=Bench(noise_memory=0.0), trials=trials, seed=6)
    for recording in made:
        if recording.conditions["repeat"] == 2:
            velocity = np.gradient(recording.channels["position_rad"], recording.channels["time_s"])
            recording.channels["torque_n_m"] += 0.02 * np.tanh(velocity / 0.02)
    floor = repeatability_floor(fit_model(make_dataset(made, FACTS, Processing(8.0)), DEFAULT))
    assert floor.rms == pytest.approx(np.hypot(0.02 / np.sqrt(2), 0.006 * np.sqrt(16 / 200)), rel=0.1)


def test_without_repeats_there_is_no_floor():
    assert repeatability_floor(fitted(plans(loads_kg=(0.0, 0.2)))) is None
    trials = [replace(plan, conditions={**plan.conditions, "repeat": 1}) for plan in plans(loads_kg=(0.0, 0.2))]
    assert repeatability_floor(fitted(trials)) is None


def test_errors_by_trial_and_regime_add_up(repeated):
    found = compare(repeated)
    assert found.training.rows == sum(trial.rows for trial in found.trials) == int(repeated.training.sum())
    power = sum(trial.rows * trial.rms**2 for trial in found.trials)
    assert found.training.rms == pytest.approx(np.sqrt(power / found.training.rows))
    assert [trial.name for trial in found.trials] == [t.signals.recording.name for t in repeated.dataset.trials]
    in_motion = repeated.dataset.regime != Regime.STUCK
    assert sum(regime.rows for regime in found.regimes) == int(in_motion.sum())
    sliding = found.regimes[0]
    assert sliding.name == "sliding"
    assert sliding.rows == int((repeated.dataset.regime == Regime.SLIDING).sum())
    assert sliding.rms < found.regimes[1].rms  # the sign of the velocity is smoothed near reversals


@pytest.mark.parametrize(("rows", "held"), [("sliding", [0]), ("moving", [0, 1]), ("all", [0, 1, 2])])
def test_which_rows_count(rows, held):
    dataset = fitted(plans(loads_kg=(0.0, 0.2)), rows=rows).dataset
    assert (dataset.counted == np.isin(dataset.regime, held)).all()


def test_residual_against_a_driver_shows_what_is_missing():
    fit = fitted(plans(loads_kg=(0.0, 0.2)), joint=Joint(extra=lambda x: 0.05 * np.cos(3 * x.q)))
    sides = {side.direction: side.bins for side in compare(fit).against if side.driver == "position"}
    assert set(sides) == {"forward", "backward"}
    for bins in sides.values():
        assert np.corrcoef(bins.mean, np.cos(3 * bins.x))[0, 1] > 0.8
        assert (bins.low < bins.mean).all()
        assert (bins.mean < bins.high).all()
    rows = fit.dataset.counted
    assert sum(int(bins.count.sum()) for bins in sides.values()) == int(rows.sum())
    motion = fit.dataset.rows_of([trial.motion.direction for trial in fit.dataset.trials])
    assert int(sides["forward"].count.sum()) == int((rows & (motion > 0)).sum())


def test_drivers_are_what_is_measured_and_varies(repeated):
    found = available(repeated.dataset)
    assert {"velocity", "position", "acceleration", "load_kg", "time"} <= set(found)
    assert "temperature" not in found  # constant
    assert set(knots_of(repeated.dataset)) >= {"velocity", "position", "load_kg"}
    assert all(len(knots) <= 7 for knots in knots_of(repeated.dataset).values())
    for name, columns in free_curves(repeated.dataset).items():
        assert np.isfinite(columns).all()
        if way_of(name) in ((variable, FORCE) for variable in knots_of(repeated.dataset)):
            assert columns.sum(axis=1) == pytest.approx(
                repeated.dataset.constant, abs=1e-3
            )  # hats sum to one, filtered or not


def test_binned_means_and_their_bars():
    random = np.random.default_rng(3)
    driver = random.uniform(-1, 1, 4800)
    stretch = np.repeat(np.arange(240), 20)
    own = 0.3 * random.standard_normal(240)[stretch]
    bins = binned_mean(driver, 2.0 * driver + own, stretch)
    assert len(bins.x) == 24
    assert bins.count.sum() == 4800
    assert (np.abs(bins.mean - 2.0 * bins.x) < 3.0 * 0.5 * (bins.high - bins.low)).all()
    # 200 rows of a bin lie in 135 stretches or so: the bar is that of 135 to 200 independent values, twice
    half = 0.5 * (bins.high - bins.low)
    assert np.median(half) == pytest.approx(2 * np.hypot(0.3, 2.0 / 24 / np.sqrt(12)) / np.sqrt(145), rel=0.2)
    clumped = binned_mean(np.repeat(random.uniform(-1, 1, 240), 20), own, stretch)
    assert np.median(clumped.high - clumped.low) == pytest.approx(2 * 2 * 0.3 / np.sqrt(10), rel=0.3)


def test_a_constant_driver_is_one_bin():
    bins = binned_mean(np.ones(50), np.arange(50.0), np.arange(50))
    assert bins.mean == pytest.approx([24.5])
    assert len(binned_mean(np.ones(3), np.arange(3.0), np.arange(3)).x) == 0


def test_repeats_at_other_times_of_the_session_are_repeats():
    made = recordings(
        trials=plans(loads_kg=(0.0, 0.2), repeats=2, temperatures_c=(25.0,)), bench=Bench(noise_memory=0.0), seed=6
    )
    plain = repeatability_floor(fit_model(make_dataset(made, FACTS, Processing(8.0)), DEFAULT))
    for number, recording in enumerate(made):
        recording.conditions["session_s"] = 20.0 * number
    timed = repeatability_floor(fit_model(make_dataset(made, FACTS, Processing(8.0)), DEFAULT))
    assert timed.rms == plain.rms
