"""Two values that dry friction jumps between are told with their height; one value, however it scatters, is not."""

import numpy as np
import pytest
from scipy.stats import binom, chi2

from compensator.lab.left_over.jumps import jumps_of
from compensator.lab.left_over.variance_components import CellsOfTrial, Part, likeliest

CELLS, CELL_S = 20, 0.25
SCATTER = (0.6, 0.3)  # white, and alike for half a second
HEIGHT = 2.5
EVERY_S = 3.0


def trials(height, seed, count=10):
    """Cells of trials whose friction jumps by so much, once in EVERY_S on average, and its course in each."""
    random = np.random.default_rng(seed)
    time_s = CELL_S * np.arange(CELLS)
    apart_s = np.abs(np.subtract.outer(time_s, time_s))
    kernels = np.array([np.eye(CELLS), np.exp(-apart_s / 0.5), np.exp(-apart_s / 3.0)])
    root = np.linalg.cholesky(np.tensordot(SCATTER, kernels[:-1], 1))
    made, courses = [], []
    for index in range(count):
        turned = np.cumsum(random.uniform(size=CELLS) < CELL_S / EVERY_S) + random.integers(2)
        course = height * (turned % 2)
        base = np.column_stack([np.ones(CELLS), random.standard_normal(CELLS)])
        left = root @ random.standard_normal(CELLS) + course + base @ [0.3, -0.2]
        made.append(CellsOfTrial(index, time_s, np.ones(CELLS), Part(base, left, kernels)))
        courses.append(course)
    return made, courses


def asked(made):
    alone, without = likeliest([one.part.without_last for one in made])
    by_variance = 2.0 * (likeliest([one.part for one in made], alone)[1].value - without.value)
    return jumps_of(made, alone), by_variance


def test_jumps_have_their_height_and_their_course():
    made, courses = trials(HEIGHT, seed=3)
    found, _ = asked(made)
    assert found.height == pytest.approx(HEIGHT, rel=0.2)
    alike = np.corrcoef(np.concatenate(found.courses), np.concatenate(courses))[0, 1]
    assert alike > 0.8


def test_two_values_say_more_than_their_variance():
    found, by_variance = zip(*(asked(trials(HEIGHT, seed)[0]) for seed in range(4)), strict=True)
    assert np.median([one.gained for one in found]) > 1.5 * np.median(by_variance)


def test_noise_gains_no_more_than_half_a_chi_squared_of_one_degree_of_freedom():
    gained = np.array([asked(trials(0.0, seed, 5)[0])[0].gained for seed in range(20)])
    chances = np.where(gained > 0.0, 0.5 * chi2.sf(np.maximum(gained, 0.0), 1), 1.0)
    assert np.sum(chances <= 0.1) <= binom.ppf(0.999, len(chances), 0.1)


def test_of_long_trials_some_moments_are_looked_at(monkeypatch):
    monkeypatch.setattr("compensator.lab.left_over.jumps.MOST_MOMENTS", 8)
    found, _ = asked(trials(HEIGHT, seed=4)[0])
    assert found.gained > 20.0
