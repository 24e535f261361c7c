"""Intervals of gains and errors: paired, by whole trials, and as often right as they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom

from compensator.lab.model.gain import Gain, error_interval, held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut, relative_error, rms

PER_UNIT = 30


def error_of(residual: np.ndarray) -> HeldOut:
    unit = np.repeat(np.arange(len(residual) // PER_UNIT), PER_UNIT)
    effort = np.full(len(residual), 2.0)
    rows = np.ones(len(residual), dtype=bool)
    return HeldOut("leave-one-trial-out", rows, residual, effort, unit, relative_error(residual, effort), rms(residual))


def pair(random: np.random.Generator, units: int, gain: float) -> tuple[HeldOut, HeldOut]:
    """Errors whose sizes differ much from trial to trial, and by `gain` between the two models."""
    size = np.repeat(np.exp(0.5 * random.standard_normal(units)), PER_UNIT)
    noise = size * random.standard_normal(units * PER_UNIT)
    missing = size * random.standard_normal(units * PER_UNIT) * np.sqrt(1.0 / (1.0 - gain) ** 2 - 1.0)
    return error_of(noise + missing), error_of(noise)


def test_the_gain_is_the_fall_of_the_error():
    before, after = pair(np.random.default_rng(1), 12, 0.3)
    found = held_out_gain(before, after)
    assert found.value == pytest.approx(1.0 - after.relative / before.relative)
    assert found.low < found.value < found.high


def test_it_is_paired_so_that_scatter_between_trials_does_not_hide_it():
    random = np.random.default_rng(2)
    before, _ = pair(random, 12, 0.0)
    after = error_of(0.98 * before.residual)
    found = held_out_gain(before, after)
    assert (found.low, found.value, found.high) == pytest.approx((0.02, 0.02, 0.02))
    assert predicts_better(after, before)
    assert not predicts_better(before, after)
    low, high = error_interval(before)
    assert low < before.relative < high
    assert high - low > 0.1 * before.relative


def test_a_gain_within_the_scatter_is_uncertain():
    random = np.random.default_rng(3)
    noise = random.standard_normal(12 * PER_UNIT)
    found = held_out_gain(error_of(noise), error_of(random.permutation(noise)))
    assert found.low < 0.0 < found.high
    assert not predicts_better(error_of(noise), error_of(random.permutation(noise)))


def test_nine_in_ten_intervals_hold_the_truth():
    sets, hits = 150, {"gain": 0, "error": 0}
    for seed in range(sets):
        before, after = pair(np.random.default_rng(100 + seed), 40, 0.2)
        found = held_out_gain(before, after)
        hits["gain"] += found.low <= 0.2 <= found.high
        low, high = error_interval(after)
        hits["error"] += low <= 0.5 * np.exp(0.25) <= high  # rms of a log-normal size, over an effort of 2
    # percentile intervals of 40 heavy-tailed units are a few per cent short of 90
    lowest, highest = binom.ppf(0.002, sets, 0.82), binom.ppf(0.998, sets, 0.90)
    assert lowest <= hits["gain"] <= highest
    assert lowest <= hits["error"] <= highest


def test_a_trial_that_no_other_tells_of_does_not_outweigh_what_they_do_tell():
    before, after = pair(np.random.default_rng(5), 12, 0.5)
    plain = held_out_gain(before, after)
    guess = np.where(before.unit == 0, 100.0, 0.0)
    spoilt = replace(after, residual=after.residual + guess)
    assert held_out_gain(before, spoilt).value < -10.0
    evenly = held_out_gain(before, replace(spoilt, weight=1.0 / np.sqrt(1.0 + guess**2)))
    assert evenly.value == pytest.approx(plain.value, abs=0.1)
    assert predicts_better(replace(spoilt, weight=1.0 / np.sqrt(1.0 + guess**2)), before)
    assert held_out_gain(before, replace(after, weight=np.ones(len(guess)))) == plain


@pytest.mark.parametrize(
    ("gain", "after", "unlike"),
    [
        (0.5, 0.05, False),
        (0.5, 0.0508, False),
        (0.5, 0.052, True),
        (0.5, 0.09, True),
        (0.5, 0.2, True),
        (0.01, 0.101, True),
    ],
)
def test_a_gain_that_the_errors_beside_it_do_not_have_is_explained(gain, after, unlike):
    words = Gain(gain, gain - 0.1, gain + 0.1).in_words(0.1, after)
    assert words.startswith(f"gain {gain:.0%}, 90 % interval")
    assert words.endswith("each row counting by how well it is known") == unlike


@pytest.mark.parametrize(("share", "words"), [(0.466, "47%"), (0.0426, "4.3%"), (-1e-9, "0%")])
def test_a_gain_has_one_form_as_the_page_has_it(share, words):
    assert Gain(share, share, share).in_words(1.0, 1.0 - share) == f"gain {words}, 90 % interval {words} .. {words}"
