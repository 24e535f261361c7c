"""Parameter intervals: the jackknife against theory."""

import numpy as np
import pytest
from scipy.stats import binom

from compensator.lab.model import intervals
from compensator.lab.model.fit import fit_model
from compensator.lab.model.intervals import estimates, standard_errors, without_each
from compensator.lab.model.weights import LIMITS, RowWeights
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, plans, recordings

LINEAR = ("inertia", "gravity", "offset", "coulomb", "viscous")
PLAIN = Joint(static_excess=0.0)


def many(trials: int) -> list[Plan]:
    random = np.random.default_rng(9)
    return [
        Plan(f"t{n}", [(0.8, 0.3, random.uniform(0, 6)), (0.4, 0.6, random.uniform(0, 6))], load_kg=0.1 * (n % 3))
        for n in range(trials)
    ]


def test_widths_are_those_of_theory():
    """With alike trials the jackknife's standard error is sqrt(sigma^2 (A'A)^-1)."""
    bench = Bench(noise_memory=0.0, duration_s=8.0)
    dataset = make_dataset(recordings(PLAIN, bench, many(24), seed=1), FACTS, Processing(8.0))
    fit = fit_model(dataset, LINEAR)
    columns = fit.columns[fit.training]
    variance = bench.noise**2 * 2 * 8.0 / bench.rate_hz * 1.25
    sigma = np.sqrt(variance * np.diag(np.linalg.inv(columns.T @ columns)))
    half = np.array([0.5 * (one.high - one.low) for one in estimates(fit)])
    assert half / sigma == pytest.approx(np.full(7, 2.07), rel=0.6)  # Student, 23 degrees of freedom
    assert np.mean(half / sigma) == pytest.approx(2.07, rel=0.25)


def test_intervals_hold_the_truth_as_often_as_they_say():
    true, hits, sets = np.array([0.02, 1.0, 0.25, 1.0, 0.01, 0.08, 0.03]), 0, 12
    for seed in range(sets):
        bench = Bench(duration_s=7.0, quantum=0.0)
        dataset = make_dataset(recordings(PLAIN, bench, many(9), seed=50 + seed), FACTS, Processing(8.0))
        for one, value in zip(estimates(fit_model(dataset, LINEAR)), true, strict=True):
            hits += one.low <= value <= one.high
    count = sets * len(true)
    assert hits >= binom.ppf(0.001, count, 0.92)


def test_shapes_and_units_are_listed_and_absent_loads_are_not():
    dataset = make_dataset(recordings(trials=plans(loads_kg=(0.0,)), seed=4), FACTS, Processing())
    found = estimates(fit_model(dataset, ["inertia", "gravity", "coulomb", "viscous", "stribeck"]))
    listed = [(one.effect, one.parameter, one.unit) for one in found]
    assert ("inertia", "inertia", "N m s2/rad") in listed
    assert ("stribeck", "Stribeck speed", "rad/s") in listed
    assert "load inertia scale" not in [name for _, name, _ in listed]  # nothing hangs
    assert len(found) == 7


def test_no_friction_may_be_larger_than_the_largest_effort(monkeypatch):
    dataset = make_dataset(recordings(seed=4), FACTS, Processing())
    fit = fit_model(dataset, ["inertia", "gravity", "coulomb", "viscous", "stribeck"])
    monkeypatch.setattr(intervals, "_half_widths", lambda fit: np.full(fit.columns.shape[1], 1e3))
    static = next(one for one in estimates(fit) if one.effect == "stribeck")
    assert static.high == pytest.approx(float(np.abs(dataset.effort).max()))


def test_rows_with_larger_residuals_weigh_less():
    dataset = make_dataset(recordings(seed=4), FACTS, Processing())
    rows = dataset.counted
    acceleration = np.abs(dataset.rows_of([trial.motion.acceleration for trial in dataset.trials]))
    fast = acceleration > np.quantile(acceleration[rows], 0.75)
    residual = np.random.default_rng(1).standard_normal(len(rows)) * np.where(fast, 2.0, 1.0)
    weights = RowWeights.learnt(dataset, residual, rows).of(dataset, rows)
    assert np.median(weights[fast[rows]]) / np.median(weights[~fast[rows]]) == pytest.approx(0.5, rel=0.15)
    assert np.median(weights) == pytest.approx(1.0, rel=0.1)
    extreme = RowWeights.learnt(dataset, residual * np.where(fast, 1e3, 1.0), rows).of(dataset, rows)
    assert LIMITS[0] <= extreme.min() < extreme.max() <= LIMITS[1]


def test_a_shape_that_is_not_known_makes_no_coefficient_surer():
    """Coulomb and Stribeck friction are known together with the Stribeck speed, or not at all."""
    dataset = make_dataset(recordings(Joint(), Bench(), many(9), seed=4), FACTS, Processing(8.0))
    fit = fit_model(dataset, [*LINEAR, "stribeck"])
    errors, count = standard_errors(fit)
    held = np.sqrt(count - 1.0) * np.std(without_each(fit), axis=0)
    assert np.all(errors >= held)
    assert errors[LINEAR.index("coulomb") + 2] > 1.2 * held[LINEAR.index("coulomb") + 2]  # inertia and gravity have two
