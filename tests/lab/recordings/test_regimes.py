"""Sliding, in transition, stuck."""

import numpy as np
import pytest

from compensator.lab.recordings.regimes import (
    CARRIED_PERIODS,
    Regime,
    classify,
    near_flank_change,
)

RATE_HZ = 200.0
CUTOFF_HZ = 20.0
MARGIN = round(CARRIED_PERIODS / CUTOFF_HZ * RATE_HZ)


def at(regime: np.ndarray, time_s: float) -> Regime:
    return Regime(regime[round(time_s * RATE_HZ)])


def test_steady_motion_slides():
    assert (classify(np.full(400, 0.5), 0.1, RATE_HZ, CUTOFF_HZ) == Regime.SLIDING).all()
    assert (classify(np.full(400, -0.5), 0.1, RATE_HZ, CUTOFF_HZ) == Regime.SLIDING).all()


def test_a_reversal_is_followed_by_a_transient():
    time_s = np.arange(0, 4, 1 / RATE_HZ)
    regime = classify(np.where(time_s < 2, 1.0, -1.0), 0.1, RATE_HZ, CUTOFF_HZ)
    assert at(regime, 1.9) == Regime.SLIDING
    assert at(regime, 2.0) == at(regime, 2.14) == Regime.TRANSIENT
    assert at(regime, 2.16) == Regime.SLIDING


def test_slow_rows_and_their_neighbours_do_not_slide():
    velocity = np.full(800, 1.0)
    velocity[400:404] = 0.05
    regime = classify(velocity, 0.1, RATE_HZ, CUTOFF_HZ)
    assert (regime[392:412] == Regime.TRANSIENT).all()  # 40 ms on either side; too short to be stuck
    assert regime[391] == regime[412] == Regime.SLIDING


def test_slow_motion_of_more_than_a_tenth_of_a_second_is_stuck():
    velocity = np.full(800, 1.0)
    velocity[400:440] = 0.08
    regime = classify(velocity, 0.1, RATE_HZ, CUTOFF_HZ)
    assert (regime[400:440] == Regime.STUCK).all()
    assert regime[399] == Regime.TRANSIENT
    velocity[400:440] = 1.0
    velocity[400:418] = 0.08  # 90 ms
    assert not (classify(velocity, 0.1, RATE_HZ, CUTOFF_HZ) == Regime.STUCK).any()


@pytest.mark.parametrize("after", [1.0, -1.0])
def test_a_stop_however_short_is_stuck_as_far_as_the_filter_carries_it(after):
    velocity = np.where(np.arange(800) < 400, 1.0, after)
    velocity[400:406] = 0.002  # creep, 30 ms
    regime = classify(velocity, 0.1, RATE_HZ, CUTOFF_HZ)
    assert np.flatnonzero(regime == Regime.STUCK).tolist() == list(range(400 - MARGIN, 406 + MARGIN))


@pytest.mark.parametrize("acceleration", [1.5, 5.0, 20.0])
def test_what_passes_through_rest_at_a_steady_acceleration_does_not_stand(acceleration):
    velocity = acceleration * (np.arange(800) - 400.5) / RATE_HZ  # slow for 130, 40 and 10 ms
    stuck = classify(velocity, 0.1, RATE_HZ, CUTOFF_HZ) == Regime.STUCK
    assert stuck.any() == (acceleration < 2.0)


def test_rows_near_a_change_of_flank():
    carried = np.where(np.arange(800) < 400, 1.0, -1.0)
    near = near_flank_change(carried, RATE_HZ)
    assert near[371:430].all()
    assert not near[:369].any()
    assert not near[432:].any()
    assert not near_flank_change(np.zeros(800), RATE_HZ).any()
    assert not near_flank_change(np.ones(800), RATE_HZ).any()
