"""What hangs beyond the gear: motions that one can follow by hand."""

import numpy as np
import pytest

from compensator.lab.recordings.far_side import parting_in_free_play, parting_on_a_spring

STEP_S = 1e-3
TIME_S = np.arange(0.0, 4.0, STEP_S)


def test_a_far_side_that_is_pushed_from_one_flank_follows():
    assert not parting_in_free_play(np.full(100, 3.0), 0.02, STEP_S).any()
    assert not parting_in_free_play(np.full(100, -3.0), 0.02, STEP_S).any()


def test_without_play_nothing_is_missing():
    assert not parting_in_free_play(np.sin(TIME_S), 0.0, STEP_S).any()


def test_a_far_side_flies_through_the_gap_and_is_caught_by_the_other_flank():
    parting = np.where(TIME_S < 1.0, 2.0, -2.0)
    found = parting_in_free_play(parting, 0.04, STEP_S)
    flight_s = np.sqrt(2.0 * 0.04 / 2.0)
    flying = (TIME_S > 1.0 + STEP_S) & (1.0 + flight_s - 3 * STEP_S > TIME_S)
    assert found[flying] == pytest.approx(-2.0)
    # the blow gives back the speed that the flight gained, and then the gear carries all again
    assert found.sum() * STEP_S == pytest.approx(0.0, abs=1e-9)
    assert np.abs(found).max() == pytest.approx(2.0 * flight_s / STEP_S, rel=0.6)
    assert not found[1.0 + flight_s + 3 * STEP_S < TIME_S].any()


def test_a_wider_gap_takes_longer_to_cross():
    parting = np.where(TIME_S < 1.0, 2.0, -2.0)
    last = [np.flatnonzero(parting_in_free_play(parting, gap, STEP_S))[-1] for gap in (0.01, 0.04)]
    assert (last[1] - 1000) == pytest.approx(2 * (last[0] - 1000), abs=4)


def test_a_stiff_spring_lags_by_the_second_rate_of_change():
    w, resonance = 2.0, 60.0
    found = parting_on_a_spring(np.sin(w * TIME_S), resonance, 0.05, STEP_S)
    settled = TIME_S > 2.0
    assert found[settled] == pytest.approx(-((w / resonance) ** 2) * np.sin(w * TIME_S[settled]), abs=1e-4)


def test_a_far_side_rings_at_its_resonance_and_a_free_one_is_left_behind():
    kicked = np.where(TIME_S < 0.1, 0.0, 1.0)
    found = parting_on_a_spring(kicked, 2.0 * np.pi * 5.0, 0.05, STEP_S)
    crossings = np.flatnonzero(np.diff(np.sign(found[TIME_S > 0.11])) != 0.0)
    assert np.diff(crossings)[:6].mean() * STEP_S == pytest.approx(0.1, rel=0.02)
    free = parting_on_a_spring(np.sin(20.0 * TIME_S), 0.1, 0.05, STEP_S)
    assert free[1000:] == pytest.approx(np.sin(20.0 * TIME_S[1000:]), abs=0.02)


@pytest.mark.parametrize("damping", [0.06, 0.25])
def test_a_far_side_dies_away_as_it_is_damped(damping):
    kicked = np.where(TIME_S < 0.1, 0.0, 1.0)
    found = np.abs(parting_on_a_spring(kicked, 2.0 * np.pi * 5.0, damping, STEP_S))
    peaks = np.flatnonzero((found[1:-1] > found[:-2]) & (found[1:-1] >= found[2:]) & (TIME_S[1:-1] > 0.12)) + 1
    decay = np.log(found[peaks[0]] / found[peaks[1]])  # half a period apart
    assert decay == pytest.approx(np.pi * damping / np.sqrt(1.0 - damping**2), rel=0.05)


@pytest.mark.parametrize("of_rate", [0.2, 0.35, 0.8])
def test_a_spring_too_stiff_to_be_seen_swinging_gives_way_by_its_stiffness(of_rate):
    w, resonance = 2.0, 2.0 * np.pi * of_rate / STEP_S
    found = parting_on_a_spring(np.sin(w * TIME_S), resonance, 0.25, STEP_S)
    settled = TIME_S > 2.0
    share = found[settled] @ np.sin(w * TIME_S[settled]) / np.sum(np.sin(w * TIME_S[settled]) ** 2)
    assert share == pytest.approx(-((w / resonance) ** 2), rel=0.5)
