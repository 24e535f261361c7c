"""The search for a steady speed, on a joint whose steady speed and time constant are known exactly."""

from math import exp, nan

import numpy as np
import pytest

from bench.experiments.analysis.saturation import (
    ARRIVED,
    Ending,
    Stroke,
    motion_of,
    next_run_up,
    remaining_rad_s,
    time_constant_s,
)

TOP_RAD_S = 6.0


def stroke(run_up, steady, time_constant, held_s=0.5, handover=0.0, stalls_below=0.0):
    """Mean speed and acceleration over the second half of what is held; a share is lost at the handover."""
    if run_up < stalls_below:
        return Stroke(run_up, 0.0, nan)
    start = (1.0 - handover) * run_up
    left = exp(-0.75 * held_s / time_constant)
    return Stroke(run_up, steady + (start - steady) * left, (steady - start) * left / time_constant)


def search(steady, time_constant, tolerance=0.01, most=12, **known):
    strokes, verdict = [], TOP_RAD_S / 2
    while not isinstance(verdict, Ending) and len(strokes) < most:
        strokes.append(stroke(verdict, steady, time_constant, **known))
        verdict = next_run_up(strokes, tolerance, TOP_RAD_S)
    return strokes, verdict


@pytest.mark.parametrize("time_constant", [0.02, 0.13, 0.5, 1.1, 3.0])
@pytest.mark.parametrize("steady", [0.3, 1.9, 3.0, 5.7])
@pytest.mark.parametrize("handover", [0.0, 0.05])
def test_the_steady_speed_is_found_within_the_tolerance(steady, time_constant, handover):
    strokes, verdict = search(steady, time_constant, handover=handover)
    assert verdict is Ending.SATURATED
    # strokes that have arrived still carry up to ARRIVED of what was lost unseen at the handover
    assert strokes[-1].speed_rad_s == pytest.approx(steady, rel=0.0101 + ARRIVED * handover)
    assert len(strokes) <= 8


def test_one_stroke_never_saturates():
    # a joint that turns at its steady speed from the first stroke on has not shown that it would stay there
    assert not isinstance(next_run_up([Stroke(3.0, 3.0, 0.0)], 0.01, TOP_RAD_S), Ending)


def test_a_speed_beyond_the_top_is_not_chased():
    strokes, verdict = search(steady=9.0, time_constant=0.6)
    assert verdict is Ending.TOO_FAST
    assert max(one.run_up_rad_s for one in strokes) == TOP_RAD_S


def test_a_level_below_friction_stalls():
    assert search(steady=1.0, time_constant=0.5, stalls_below=99.0)[1] is Ending.STALLED


def test_run_ups_stay_above_the_speed_that_stalls():
    # the first guess, from a time constant of 0.5 s, falls below the speed at which friction is least
    strokes, verdict = search(steady=1.2, time_constant=0.4, stalls_below=1.0)
    assert verdict is Ending.SATURATED
    assert strokes[-1].speed_rad_s == pytest.approx(1.2, rel=0.0101)


def test_the_time_constant_by_hand():
    strokes = [Stroke(2.0, 2.0, 1.0), Stroke(3.0, 3.0, 0.5)]
    assert time_constant_s(strokes) == pytest.approx(2.0)
    assert remaining_rad_s(strokes) == pytest.approx(1.0)


def test_speed_that_feeds_itself_has_no_time_constant():
    assert np.isnan(time_constant_s([Stroke(2.0, 2.0, 0.5), Stroke(3.0, 3.0, 1.0)]))


def test_motion_by_hand():
    time_s = np.arange(20) * 0.005 + 7.0
    speed, acceleration = motion_of(time_s, 1.0 + 3.0 * (time_s - time_s.mean()) + 0.25 * (time_s - time_s.mean()) ** 2)
    assert speed == pytest.approx(3.0)
    assert acceleration == pytest.approx(0.5)


def test_one_falsified_stroke_does_not_look_saturated():
    # the third should show 0.9 rad/s2; the last two alone would give a time constant of 0.14 s and 0.04 rad/s to come
    strokes = [Stroke(3.0, 3.0, 2.0), Stroke(4.0, 4.0, 1.0), Stroke(4.1, 4.1, 0.3)]
    assert next_run_up(strokes, 0.02, TOP_RAD_S) is not Ending.SATURATED


def test_strokes_that_meet_by_chance_while_accelerating_have_not_arrived():
    strokes = [Stroke(3.1, 2.46, -0.3), Stroke(2.4, 2.445, 0.3)]
    assert next_run_up(strokes, 0.02, TOP_RAD_S) is not Ending.SATURATED
