"""Whitened rows have noise that is the same in all of them, and independent."""

import numpy as np
import pytest

from compensator.lab.screening import whitening
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.whitening import Whitening
from tests.lab.screening.test_noise import ALL, NOTHING, ROWS, coloured, dataset, from_stop_to_stop, learnt, scattering


def lag_one(values: np.ndarray) -> float:
    return float(values[:-1] @ values[1:] / (values @ values))


def test_noise_is_of_unit_power_and_independent_from_row_to_row():
    random = np.random.default_rng(1)
    noise = learnt(np.concatenate([coloured(random)]))
    found = Whitening.of(noise).whitened(np.column_stack([coloured(random) for _ in range(20)]))
    assert np.mean(found**2) == pytest.approx(1.0, abs=0.15)
    assert abs(np.mean([lag_one(one) for one in found.T])) < 0.1
    assert lag_one(coloured(random)) > 0.7


def test_a_trial_that_scatters_more_counts_for_less():
    random = np.random.default_rng(6)
    wild = np.where(np.arange(len(ALL)) < len(ALL) // 2, 3.0, 1.0)
    noise = learnt(wild * coloured(random))
    found = Whitening.of(noise).whitened(np.column_stack([wild * coloured(random) for _ in range(20)]))
    for half in np.array_split(found, 2):
        assert np.mean(half**2) == pytest.approx(1.0, abs=0.25)


def test_what_is_whitened_stays_where_it_was():
    hit = np.zeros((len(ALL), 1))
    hit[300] = 1.0
    found = Whitening.of(learnt(coloured(np.random.default_rng(2)))).whitened(hit)[:, 0]
    assert np.argmax(np.abs(found)) == 300
    assert np.sum(found[290:311] ** 2) > 0.95 * np.sum(found**2)


def test_pieces_of_a_long_trial_are_whitened_nearly_as_the_whole(monkeypatch):
    random = np.random.default_rng(3)
    noise, values = learnt(coloured(random)), coloured(random)[:, None]
    whole = Whitening.of(noise).whitened(values)
    monkeypatch.setattr(whitening, "MOST_ROWS", ROWS // 2)
    pieces = Whitening.of(noise)
    assert len(pieces.pieces) == 2 * len(noise.places)
    assert np.std(pieces.whitened(values) - whole) < 0.2 * np.std(whole)


def test_static_friction_that_differs_from_stop_to_stop_counts_for_little():
    random, strokes = np.random.default_rng(4), from_stop_to_stop()
    noise = Noise.learnt(dataset(), ALL, (NOTHING, scattering(random, 0.3)), before=1.0, strokes=strokes)
    assert noise.from_stop_to_stop > 0.0
    slow = np.where(strokes.index == 0, strokes.share, 0.0)[:, None]
    fast = 0.2 * np.where(strokes.index == 2, 1.0, 0.0)[:, None]
    sizes = [np.sum(Whitening.of(noise).whitened(one) ** 2) / np.sum(one**2) for one in (slow, fast)]
    assert sizes[0] < 0.3 * sizes[1]


def test_what_a_filter_leaves_next_to_none_of_is_not_known_without_end():
    """Nobody knows noise in a band that was taken away: it counts for ten times the mean or so."""
    random = np.random.default_rng(5)
    smooth = np.convolve(coloured(random), np.hanning(25), "same")
    noise = learnt(smooth / np.std(smooth))
    quick = np.where(np.arange(len(ALL)) % 2 == 0, 1.0, -1.0)[:, None]
    assert np.mean(Whitening.of(noise).whitened(quick) ** 2) < 20.0
