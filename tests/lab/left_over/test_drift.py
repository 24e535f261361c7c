"""A coefficient that wanders is told from one that is constant as often as chance says, and no more."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.drift import MEMORY_S, MOMENT_S, chance_of_drift, moments_of
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

TRIALS, MOMENTS, ROWS = 8, 12, 10  # rows in a moment
COLUMN = np.sign(np.sin(np.linspace(0.0, 300.0, TRIALS * MOMENTS * ROWS)))
TIME = np.tile(np.linspace(-1.0, 1.0, MOMENTS * ROWS), TRIALS)
COLUMNS = np.column_stack([COLUMN, TIME, COLUMN * TIME])
PLACES = (
    np.arange(TRIALS * MOMENTS * ROWS) // ROWS,
    np.repeat(np.arange(TRIALS), MOMENTS),
    MOMENT_S * np.tile(np.arange(MOMENTS), TRIALS).astype(float),
)


def chance(drift, random) -> float:
    """Of a coefficient that follows `drift`, one value for each moment, in white noise of power 1."""
    effort = random.standard_normal(len(COLUMN)) + COLUMN * np.repeat(drift, ROWS)
    return chance_of_drift(PLACES, Base.of(COLUMNS, effort), COLUMN, 1.0)


def test_chances_of_noise_are_spread_evenly():
    random = np.random.default_rng(4)
    found = np.array([chance(np.zeros(TRIALS * MOMENTS), random) for _ in range(400)])
    for share in (0.05, 0.2, 0.5, 0.8):
        assert np.mean(found <= share) == pytest.approx(share, abs=3.5 * np.sqrt(share * (1 - share) / 400))


def test_mean_and_variance_are_those_of_the_dense_quadratic_form():
    random = np.random.default_rng(5)
    moment, trial, time_s = PLACES
    alike = np.exp(-np.abs(np.subtract.outer(time_s, time_s)) / MEMORY_S) * (trial[:, None] == trial)
    picks = COLUMN[:, None] * (moment[:, None] == np.arange(len(trial)))
    base = Base.of(COLUMNS, random.standard_normal(len(COLUMN)))
    free = picks - base.basis @ (base.basis.T @ picks)
    powers = np.linalg.eigvals(alike @ (free.T @ free)).real
    score = picks.T @ base.residual
    draws = random.standard_normal((20000, len(powers))) ** 2 @ powers
    size = score @ alike @ score
    expected = np.mean(draws >= size)
    assert chance_of_drift(PLACES, base, COLUMN, 1.0) == pytest.approx(expected, abs=0.02)


def test_a_coefficient_that_jumps_now_and_then_is_told_where_stretches_of_its_own_could_not_say():
    random = np.random.default_rng(6)
    jumps = np.cumsum(random.random(TRIALS * MOMENTS) < MOMENT_S / 4.0) % 2
    assert chance(0.45 * jumps, random) < 1e-4


def test_a_trial_without_a_usable_row_has_no_moment_and_stops_no_diagnosis():
    made = recordings(Joint(extra=lambda x: 0.004 * np.sign(x.v) * (x.time_s > 3.0)), Bench(duration_s=6.0), plans())
    last = made[-1]
    off = replace(last, channels={**last.channels, "enabled": np.zeros(len(last))})  # the power stage was never on
    dataset = make_dataset([*made[:-1], off], FACTS, Processing(cutoff_hz=8.0))
    _, trials, _ = moments_of(dataset, dataset.counted)
    assert set(trials) == set(range(len(made) - 1))
    assert diagnose(fit_model(dataset, default_effects(FACTS))).sentence
