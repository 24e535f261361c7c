"""The low-pass keeps phase, and is scipy's own, whatever the shape of what it filters."""

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from compensator.lab.recordings.low_pass import (
    FILTER_ORDER,
    band_pass_thinned,
    filter_sections,
    low_pass,
    low_pass_thinned,
)

CUTOFF_HZ = 8.0


def test_the_low_pass_keeps_phase_and_halves_power_at_its_corner():
    time_s = np.arange(0, 20, 1 / 200)
    for frequency_hz, gain in ((0.5, 1.0), (CUTOFF_HZ, 0.5), (4 * CUTOFF_HZ, 4.0 ** -(2 * FILTER_ORDER))):
        wave = np.sin(2 * np.pi * frequency_hz * time_s)
        inner = slice(800, -800)
        found = low_pass(wave, CUTOFF_HZ, 200.0)[inner]
        assert found @ wave[inner] / (wave[inner] @ wave[inner]) == pytest.approx(gain, rel=0.02, abs=1e-5)
    assert low_pass(wave, 99.0, 200.0) is wave  # beyond Nyquist there is nothing to take away


@pytest.mark.parametrize("shape", [(700,), (1, 700), (7, 700)])
@pytest.mark.parametrize(("cutoff_hz", "rate_hz"), [(8.0, 200.0), (90.0, 200.0), (2.0, 1000.0)])
def test_columns_side_by_side_are_filtered_as_scipy_filters_each(shape, cutoff_hz, rate_hz):
    values = np.random.default_rng(1).standard_normal(shape)
    before = values.copy()
    sections, _ = filter_sections(cutoff_hz, rate_hz)
    wanted = sosfiltfilt(sections, values, axis=-1, padtype="odd", padlen=3 * (2 * len(sections) + 1))
    found = low_pass(values, cutoff_hz, rate_hz)
    assert found.shape == shape
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12)
    assert (values == before).all()


@pytest.mark.parametrize("high_hz", [9.0, 120.0])  # of one the band would end beyond Nyquist
def test_a_band_is_passed_as_scipy_passes_it(high_hz):
    values, picked = np.random.default_rng(4).standard_normal((3, 700)), np.arange(0, 700, 9)
    sections = butter(2, (2.0, min(high_hz, 90.0)), btype="bandpass", fs=200.0, output="sos")
    wanted = sosfiltfilt(sections, values, axis=-1)[:, picked].T
    assert band_pass_thinned(values, 2.0, high_hz, 200.0, picked) == pytest.approx(wanted, rel=1e-9, abs=1e-12)


def test_whole_numbers_are_filtered_as_numbers():
    steps = np.repeat([0, 100], 300)
    assert low_pass(steps, CUTOFF_HZ, 200.0) == pytest.approx(low_pass(steps.astype(float), CUTOFF_HZ, 200.0))


def test_blocks_of_any_length_and_rate_are_filtered_at_once_as_each_alone():
    random = np.random.default_rng(2)
    rates_hz = [200.0, 210.0, 1000.0, 15.0, 200.0]  # of one the cut-off is beyond Nyquist
    blocks = [random.standard_normal((3, count)) for count in (300, 900, 900, 200, 400)]
    picked = [np.arange(0, block.shape[1], step) for block, step in zip(blocks, (1, 7, 3, 2, 400), strict=True)]
    found = low_pass_thinned(blocks, CUTOFF_HZ, rates_hz, picked)
    each = [low_pass(block, CUTOFF_HZ, rate_hz) for block, rate_hz in zip(blocks, rates_hz, strict=True)]
    assert np.array_equal(found, np.concatenate([one[:, own].T for one, own in zip(each, picked, strict=True)]))


def test_columns_of_zeros_stay_what_they_are_and_their_neighbours_are_filtered():
    waves = np.random.default_rng(3).standard_normal((3, 300))
    waves[1] = 0.0
    for block in (waves, np.zeros((3, 300)), waves * (np.arange(300) != 150)):  # the middle sample tells of none
        found = low_pass_thinned([block], CUTOFF_HZ, [200.0], [np.arange(300)])
        assert np.array_equal(found.T[[0, 2]], low_pass(block[[0, 2]], CUTOFF_HZ, 200.0))
        assert (found.T[1] == 0.0).all()
