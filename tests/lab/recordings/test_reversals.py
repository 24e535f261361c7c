"""What a joint remembers: strokes, deflection, free play and rests, on motions that one can follow by hand."""

import numpy as np
import pytest

from compensator.lab.effects.friction.memory.dwell_strengthening import columns
from compensator.lab.recordings.reversals import REST_S, deflection, since_rest, slider, strokes_of
from tests.lab.effects.test_effects import motion

THERE_AND_BACK = np.array([0.0, 1.0, 2.0, 2.0, 1.5, 0.5, 1.0])


def test_strokes_begin_at_the_turning_points():
    strokes = strokes_of(THERE_AND_BACK)
    assert strokes.sign.tolist() == [1.0, -1.0, 1.0]
    assert strokes.start.tolist() == [0.0, 2.0, 0.5]
    assert strokes.travel.tolist() == [0.0, 1.0, 2.0, 2.0, 0.5, 1.5, 0.5]


def test_a_motion_that_stands_is_one_stroke_of_no_length():
    strokes = strokes_of(np.full(5, 0.3))
    assert not strokes.travel.any()
    assert not deflection(strokes, 0.1).any()


def test_deflection_comes_up_over_its_distance_and_turns_over_twice_as_much():
    rising = strokes_of(np.linspace(0.0, 1.0, 101))
    state = deflection(rising, 0.1)
    assert state[10] == pytest.approx(1.0 - np.exp(-1.0))
    turned = deflection(strokes_of(np.concatenate([np.linspace(0, 5, 51), np.linspace(4.9, 0, 50)])), 0.1)
    # from +1 it passes zero after distance x ln 2
    assert turned[51] == pytest.approx(-1.0 + 2.0 * np.exp(-1.0))
    assert turned[-1] == pytest.approx(-1.0)


def test_a_slider_gives_way_at_its_distance_and_closes_the_loops_within():
    there_and_back = strokes_of(np.concatenate([np.linspace(0.0, 2.0, 21), np.linspace(1.9, 0.0, 20)]))
    state = slider(there_and_back, 0.5)
    assert state[:6] == pytest.approx(np.linspace(0.0, 1.0, 6))
    assert state[6:21] == pytest.approx(np.ones(15))
    assert state[25] == pytest.approx(0.0)
    assert state[30:] == pytest.approx(-np.ones(11))
    within = np.concatenate([np.linspace(0.0, 2.0, 21), np.linspace(1.9, 1.8, 2), np.linspace(1.9, 2.0, 2)])
    assert slider(strokes_of(within), 0.5)[20:] == pytest.approx([1.0, 0.8, 0.6, 0.8, 1.0])


def test_a_rest_is_measured_and_forgotten_over_the_travel_since():
    time_s = np.arange(0.0, 3.0, 0.01)
    velocity = np.where((time_s >= 1.0) & (time_s < 2.0), 0.0, 0.5)
    position = np.cumsum(velocity) * 0.01
    dwell_s, travel = since_rest(position, velocity, time_s, 0.1)
    assert not dwell_s[:150].any()
    assert np.isinf(travel[:150]).all()
    after = time_s > 2.3
    assert dwell_s[after] == pytest.approx(0.99)
    assert travel[after][0] == pytest.approx(0.5 * 0.31, abs=0.011)


def test_dwell_rises_with_the_logarithm_of_the_rest():
    def excess(rest_s: float) -> float:
        time_s = np.arange(0.0, 3.0 + rest_s, 0.01)
        velocity = np.where((time_s >= 1.0) & (time_s < 1.0 + rest_s), 0.0, 0.5)
        known = motion()
        fields = {name: getattr(known, name) for name in known.__dataclass_fields__}
        fields |= {"time_s": time_s, "velocity": velocity, "position": np.cumsum(velocity) * 0.01}
        moved = type(known)(**{**fields, "direction": np.sign(velocity), "slow": 0.1})
        return float(columns(moved, (0.2,))[0].max())

    short, long = excess(0.5), excess(5.0)
    assert short == pytest.approx(np.log1p(0.5 / REST_S), rel=0.05)
    assert long - short == pytest.approx(np.log(10.0), rel=0.1)
