"""The law of reflection and of following, and what is read from recordings of it."""

from math import nan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compensator.errors import ModelParameterError
from compensator.reflection.reflection import Following, Reflection
from compensator.reflection.reflection_quality import delay_s, drag, rise_s, swing, unexplained

LAW = Reflection(force_scale=2.0, torque_n_m=1.0, slew_n_m_s=20.0, damping_n_m_s_rad=0.1, period_s=0.005)
PATH = Following(
    master_rad=0.2, slave_rad=0.5, scale=0.5, low_rad=-1.0, high_rad=1.0, speed_rad_s=4.0, period_s=0.005
)  # fmt: skip


def after(law, load_n_m, cycles, start_n_m=0.0):
    for _ in range(cycles):
        start_n_m = law.reflected_n_m(start_n_m, load_n_m)
    return start_n_m


def test_a_load_is_reflected_in_proportion_once_the_slew_has_let_it():
    assert after(LAW, 0.3, 1) == pytest.approx(0.1)  # 20 N m/s in 5 ms
    assert after(LAW, 0.3, 50) == pytest.approx(0.6)
    assert LAW.motor_n_m(0.6, 0.0) == pytest.approx(-0.6)


def test_what_is_not_known_is_let_go():
    assert after(LAW, nan, 3, start_n_m=0.6) == pytest.approx(0.3)
    assert after(LAW, nan, 50, start_n_m=0.6) == 0.0


@given(st.lists(st.floats(allow_nan=True, allow_infinity=True), min_size=1, max_size=20))
def test_no_load_however_wild_gets_past_limit_and_slew(loads):
    reflected = 0.0
    for load_n_m in loads:
        before, reflected = reflected, LAW.reflected_n_m(reflected, load_n_m)
        assert abs(reflected) <= LAW.torque_n_m
        assert abs(reflected - before) <= LAW.slew_n_m_s * LAW.period_s + 1e-12


@given(speed=st.floats(-10.0, 10.0))
def test_damping_only_takes_energy(speed):
    assert LAW.motor_n_m(0.0, speed) * speed <= 0.0


@pytest.mark.parametrize(
    "wrong", [{"force_scale": -1.0}, {"force_scale": nan}, {"torque_n_m": 0.0}, {"slew_n_m_s": -1.0}, {"period_s": 0.0}]
)
def test_impossible_laws_are_refused(wrong):
    plain = {"force_scale": 1.0, "torque_n_m": 1.0, "slew_n_m_s": 1.0, "damping_n_m_s_rad": 0.0, "period_s": 0.01}
    with pytest.raises(ModelParameterError):
        Reflection(**(plain | wrong))


def test_the_slave_goes_the_scaled_way_from_where_it_stood():
    assert PATH.set_point(0.5, 0.2, 0.0).position_rad == 0.5
    followed = PATH.set_point(0.5, 0.22, 1.0)
    assert followed == pytest.approx((0.51, 0.5))


def test_the_slave_s_set_point_keeps_to_its_limits_and_its_speed():
    assert PATH.set_point(1.0, 5.0, 3.0) == pytest.approx((1.0, 0.0))
    assert PATH.set_point(0.5, -5.0, -3.0) == pytest.approx((0.48, -4.0))


def test_the_delay_is_found_between_samples():
    time_s = np.arange(0.0, 4.0, 0.005)
    truth = np.sin(2 * pi * 0.5 * time_s)
    late = 0.7 * np.sin(2 * pi * 0.5 * (time_s - 0.0432)) + 0.2  # scale and offset are no delay
    assert delay_s(late, truth, 0.005) == pytest.approx(0.0432, abs=1e-3)


def test_what_comes_before_its_cause_is_no_image_of_it():
    time_s = np.arange(0.0, 4.0, 0.005)
    truth = np.sin(2 * pi * 0.5 * time_s)
    assert delay_s(np.sin(2 * pi * 0.5 * (time_s + 0.0432)), truth, 0.005) is None


def test_noise_has_no_delay():
    generator = np.random.default_rng(5)
    assert delay_s(generator.normal(size=800), generator.normal(size=800), 0.005) is None
    assert delay_s(np.zeros(800), generator.normal(size=800), 0.005) is None


def test_a_limit_cycle_turns_again_and_again():
    time_s = np.arange(0.0, 1.0, 0.005)
    found = swing(0.01 * np.sin(2 * pi * 4.0 * time_s), threshold_rad=0.001)
    assert found.is_limit_cycle
    assert found.turns in (7, 8)
    assert found.amplitude_rad == pytest.approx(0.01, rel=0.01)


def test_what_creeps_settles_or_trembles_by_a_count_is_none():
    time_s = np.arange(0.0, 1.0, 0.005)
    creeping = 0.1 * time_s
    settling = 0.1 * np.exp(-10.0 * time_s) * np.cos(2 * pi * 2.0 * time_s)
    trembling = 1e-4 * (np.arange(200) % 2)
    for position in (creeping, settling, trembling, np.zeros(200)):
        assert not swing(position, threshold_rad=0.002).is_limit_cycle


def test_changes_alone_are_scaled_about_a_load():
    about = Reflection(3.0, 1.0, 20.0, 0.0, 0.005, about_n_m=0.6)
    assert after(about, 0.6, 50) == pytest.approx(0.6)
    # without it, three times the load is beyond the limit, and changes nothing
    assert after(about, 0.7, 50) == pytest.approx(0.9)
    assert after(Reflection(3.0, 1.0, 20.0, 0.0, 0.005), 0.7, 50) == after(LAW, 0.7, 50) == 1.0


def hit(late=0, height=1.0):
    """A load that jumps from 0.2, and what is reflected of it so many samples later."""
    truth = np.concatenate([np.full(50, 0.2), np.full(50, 0.2 + height)])
    return np.concatenate([np.full(late, 0.2), truth[: len(truth) - late]]), truth


def test_what_a_short_delay_explains_is_no_error():
    reflected, truth = hit(late=6)
    assert np.max(np.abs(reflected - truth)) == pytest.approx(1.0)
    assert np.max(unexplained(reflected, truth, 6)) == 0.0
    assert np.max(unexplained(reflected, truth, 5)) == pytest.approx(1.0)
    assert np.max(unexplained(reflected + 0.1, truth, 6)) == pytest.approx(0.1)


@pytest.mark.parametrize("height", [1.0, -1.0])
def test_the_rise_after_a_hit_is_its_delay(height):
    assert rise_s(*hit(late=6, height=height), 0.005, 0.1) == pytest.approx(6 * 0.005)
    _, truth = hit(height=height)
    slow = truth.copy()
    slow[50:] -= height * np.exp(-np.arange(50) / 10.0)
    assert rise_s(slow, truth, 0.005, 0.1) == pytest.approx(10 * np.log(2.0) * 0.005, abs=0.005)


def test_without_a_jump_there_is_no_rise():
    ramp = np.linspace(0.0, 1.0, 100)
    assert rise_s(ramp, ramp, 0.005, 0.1) is None
    assert rise_s(*hit(height=0.05), 0.005, 0.1) is None
    assert rise_s(np.zeros(5), np.zeros(5), 0.005, 0.1) is None
    reflected, truth = hit()
    assert rise_s(np.zeros_like(reflected), truth, 0.005, 0.1) is None


def test_drag_is_what_resists_the_hand_beside_the_load():
    hand_rad = np.concatenate([np.linspace(0.0, 1.0, 101), np.linspace(1.0, 0.0, 101)])
    truth = 0.5 * np.sin(hand_rad)
    way = np.sign(np.diff(hand_rad, prepend=-0.01))
    assert drag(truth, truth, hand_rad) == 0.0
    assert drag(truth + 0.1 * way, truth, hand_rad) == pytest.approx(0.1, rel=0.02)
    # what comes late drives the hand on: a spring that gives back more than it took
    late = np.concatenate([truth[:5], truth[:-5]])
    assert drag(late, truth, hand_rad) < -0.01
    assert drag(truth, truth, np.zeros_like(hand_rad)) == 0.0
