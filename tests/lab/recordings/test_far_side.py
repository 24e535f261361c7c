"""What hangs beyond the gear: motions that one can follow by hand."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from compensator.lab.recordings.far_side import in_free_play, parting_on_a_spring

STEP_S = 1e-3
TIME_S = np.arange(0.0, 4.0, STEP_S)


def test_a_far_side_that_is_pushed_from_one_flank_follows():
    assert not in_free_play(np.full(100, 3.0), 0.02, STEP_S)[0].any()
    assert not in_free_play(np.full(100, -3.0), 0.02, STEP_S)[0].any()


def test_without_play_nothing_is_missing():
    assert not in_free_play(np.sin(TIME_S), 0.0, STEP_S)[0].any()


def test_a_far_side_flies_through_the_gap_and_is_caught_by_the_other_flank():
    parting = np.where(TIME_S < 1.0, 2.0, -2.0)
    found, _ = in_free_play(parting, 0.04, STEP_S)
    flight_s = np.sqrt(2.0 * 0.04 / 2.0)
    flying = (TIME_S > 1.0 + STEP_S) & (1.0 + flight_s - 3 * STEP_S > TIME_S)
    assert found[flying] == pytest.approx(-2.0)
    # the blow gives back the speed that the flight gained, and then the gear carries all again
    assert found.sum() * STEP_S == pytest.approx(0.0, abs=1e-9)
    assert np.abs(found).max() == pytest.approx(2.0 * flight_s / STEP_S, rel=0.6)
    assert not found[1.0 + flight_s + 3 * STEP_S < TIME_S].any()


def test_a_wider_gap_takes_longer_to_cross():
    parting = np.where(TIME_S < 1.0, 2.0, -2.0)
    last = [np.flatnonzero(in_free_play(parting, gap, STEP_S)[0])[-1] for gap in (0.01, 0.04)]
    assert (last[1] - 1000) == pytest.approx(2 * (last[0] - 1000), abs=4)


def test_a_far_side_that_flies_far_swings_as_the_slope_of_its_load_pulls():
    parting, slope, half = np.where(TIME_S < 1.0, 30.0, -2.0), 4.0, 5.0
    _, ways = in_free_play(parting, 2.0 * half, STEP_S, slope)
    expected = -0.5 + (half + 0.5) * np.cos(2.0 * (TIME_S - 1.0))
    flying = (TIME_S > 1.0) & (TIME_S < 2.2)
    assert ways[flying] == pytest.approx(expected[flying], abs=0.03)


def test_a_far_side_hangs_half_the_gap_away_and_swings_within_it_as_a_pendulum_on_stiff_flanks():
    """What a motor that is moved to and fro carries of a pendulum, beside the equation with flanks of stiff springs."""
    inertia, moment, gap, stiffness, damping = 0.02, 0.5, 0.1, 4000.0, 8.0
    q, a = 0.9 * np.sin(TIME_S * 3.0), -8.1 * np.sin(TIME_S * 3.0)

    def carried(time_s, way, speed):
        pressed = way - np.clip(way, -0.5 * gap, 0.5 * gap)
        return stiffness * pressed + damping * speed * (pressed != 0.0)

    def rates(time_s, state):
        way, speed = state
        angle = 0.9 * np.sin(3.0 * time_s) - way
        needed = -8.1 * inertia * np.sin(3.0 * time_s) + moment * np.sin(angle)
        return [speed, (needed - carried(time_s, way, speed)) / inertia]

    swung = solve_ivp(rates, (0.0, TIME_S[-1]), [0.5 * gap, 0.0], t_eval=TIME_S, rtol=1e-7, atol=1e-9, max_step=1e-3)
    wanted = carried(TIME_S, *swung.y) - (inertia * a + moment * np.sin(q))
    parting, slope = a + moment * np.sin(q) / inertia, moment * np.cos(q)
    second, ways = in_free_play(parting, gap, STEP_S, slope / inertia)
    found = -(inertia * second + slope * ways)
    resting = (np.abs(ways) >= 0.5 * gap - 1e-12) & (np.abs(swung.y[0]) >= 0.5 * gap)
    off = np.abs(found - wanted)[resting] / (0.5 * gap * moment)
    assert np.quantile(off, 0.95) < 0.05  # but where a blow sounds on in the stiff flank
    assert np.median(np.abs(wanted[resting])) > 0.25 * gap * moment  # were the load where the motor is: nothing


def test_a_stiff_spring_lags_by_the_second_rate_of_change():
    w, resonance = 2.0, 60.0
    found = parting_on_a_spring(np.sin(w * TIME_S), resonance, 0.05, STEP_S)
    settled = TIME_S > 2.0
    assert found[settled] == pytest.approx(-((w / resonance) ** 2) * np.sin(w * TIME_S[settled]), abs=1e-4)


def test_a_far_side_rings_at_its_resonance_and_a_free_one_is_left_behind():
    kicked = np.where(TIME_S < 0.1, 0.0, 1.0)
    found = parting_on_a_spring(kicked, 2.0 * np.pi * 5.0, 0.05, STEP_S)
    crossings = np.flatnonzero(np.diff(np.sign(found[TIME_S > 0.12])) != 0.0)
    assert np.diff(crossings)[:6].mean() * STEP_S == pytest.approx(0.1, rel=0.02)
    free = parting_on_a_spring(np.sin(20.0 * TIME_S), 0.1, 0.5, STEP_S)
    assert free[1000:-200] == pytest.approx(np.sin(20.0 * TIME_S[1000:-200]), abs=0.02)


def test_what_hardly_hangs_on_its_spring_takes_no_memory():
    """Beside a load whose inertia is nearly all, the arm's resonance goes to nothing, and its decay takes days."""
    found = parting_on_a_spring(np.sin(20.0 * TIME_S), 1e-3, 1e-5, STEP_S)
    assert found[10:-10] == pytest.approx(np.sin(20.0 * TIME_S[10:-10]), abs=0.02)


@pytest.mark.parametrize(("hertz", "damping", "step_s"), [(3.0, 0.06, 0.02), (12.0, 0.2, 0.02), (40.0, 0.1, 0.02)])
def test_it_moves_as_the_equation_says_also_where_samples_cannot_show_its_swing(hertz, damping, step_s):
    time_s, w = np.arange(0.0, 6.0, step_s), 2.0 * np.pi * hertz

    def parting(t):
        return np.sin(2.0 * np.pi * 1.3 * t) * np.sin(np.pi * t / 6.0) ** 2

    def rates(t, state):
        return [state[1], parting(t) - 2.0 * damping * w * state[1] - w**2 * state[0]]

    way, speed = solve_ivp(rates, (0.0, 6.0), [0.0, 0.0], t_eval=time_s, rtol=1e-8, atol=1e-12, max_step=0.002).y
    wanted = parting(time_s) - 2.0 * damping * w * speed - w**2 * way
    found = parting_on_a_spring(parting(time_s), w, damping, step_s)
    assert found[:-3] == pytest.approx(wanted[:-3], abs=5e-3 * np.abs(wanted).max())


@pytest.mark.parametrize("damping", [0.06, 0.25])
def test_a_far_side_dies_away_as_it_is_damped(damping):
    kicked = np.where(TIME_S < 0.1, 0.0, 1.0)
    found = np.abs(parting_on_a_spring(kicked, 2.0 * np.pi * 5.0, damping, STEP_S))
    peaks = np.flatnonzero((found[1:-1] > found[:-2]) & (found[1:-1] >= found[2:]) & (TIME_S[1:-1] > 0.12)) + 1
    decay = np.log(found[peaks[0]] / found[peaks[1]])  # half a period apart
    assert decay == pytest.approx(np.pi * damping / np.sqrt(1.0 - damping**2), rel=0.05)


@pytest.mark.parametrize("of_rate", [0.2, 0.35, 0.8, 3.0])
def test_a_spring_too_stiff_to_be_seen_swinging_gives_way_by_its_stiffness(of_rate):
    w, resonance = 2.0, 2.0 * np.pi * of_rate / STEP_S
    found = parting_on_a_spring(np.sin(w * TIME_S), resonance, 0.25, STEP_S)
    settled = (TIME_S > 2.0) & (TIME_S[-1] - 1.0 > TIME_S)
    share = found[settled] @ np.sin(w * TIME_S[settled]) / np.sum(np.sin(w * TIME_S[settled]) ** 2)
    assert share == pytest.approx(-((w / resonance) ** 2), rel=0.01)
