from math import floor, isnan, pi

import numpy as np
import pytest

from sim_backend.mechanisms.motor.motor import VOLTAGE
from tests.sim_backend.plants import RATIO, RESISTANCE, SUPPLY, K, plant, run

COUNT_RAD = 2.0 * pi / 4096 / RATIO


def test_position_is_whole_counts_of_the_motor_shaft() -> None:
    turned = plant(gear={"backlash_rad": 0.5})
    for _ in range(100):
        measured = turned.advance(VOLTAGE, 0.05, 7)
        assert measured[0] == pytest.approx(floor(turned.truth().rotor_rad / COUNT_RAD) * COUNT_RAD, abs=1e-12)
    assert abs(turned.truth().rotor_rad - turned.truth().arm_rad) > 0.1


def test_speed_is_counts_gained_over_the_window() -> None:
    turned = plant(friction={"viscous_n_m_s_rad": 1e-4})
    run(turned, 0.5, 5.0)
    speeds = [float(turned.advance(VOLTAGE, 0.5, 13)[1]) for _ in range(200)]
    count_speed = COUNT_RAD / 5e-3
    true = turned.truth().rotor_rad_s
    assert max(abs(speed - true) for speed in speeds) <= count_speed
    assert np.mean(speeds) == pytest.approx(true, abs=0.1 * count_speed)
    assert all(abs(speed / count_speed - round(speed / count_speed)) < 1e-6 for speed in speeds)


def test_latency_shows_the_past() -> None:
    prompt, late = plant(), plant(latency={"delay_s": 3e-3})
    seen = [prompt.advance(VOLTAGE, 0.3, 10) for _ in range(20)]
    delayed = [late.advance(VOLTAGE, 0.3, 10) for _ in range(20)]
    assert np.array_equal(np.array(delayed)[3:, :2], np.array(seen)[:-3, :2])
    assert prompt.truth() == late.truth()


def test_current_is_absent_without_a_sensor() -> None:
    assert isnan(plant().advance(VOLTAGE, 0.3, 10)[2])


def test_current_sensor_has_gain_offset_and_noise() -> None:
    held = plant(
        friction={"coulomb_n_m": 9.0, "static_n_m": 9.0},
        current_sensor={"present": True, "gain": 1.1, "offset_a": 0.05, "noise_a": 0.02},
    )
    currents = np.array([held.advance(VOLTAGE, 0.3, 10)[2] for _ in range(4000)])
    assert currents.mean() == pytest.approx(1.1 * 0.3 * SUPPLY / RESISTANCE + 0.05, abs=4 * 0.02 / np.sqrt(4000))
    assert currents.std() == pytest.approx(0.02, rel=0.05)
    assert abs(np.corrcoef(currents[1:], currents[:-1])[0, 1]) < 4 / np.sqrt(4000)


def test_measured_current_of_a_running_motor_is_what_eq_3_gives() -> None:
    running = plant(current_sensor={"present": True}, friction={"viscous_n_m_s_rad": 1e-4})
    for duty in (0.2, -0.7, 0.4):
        measured = running.advance(VOLTAGE, duty, 3000)
        inferred = (SUPPLY * duty - K * RATIO * running.truth().rotor_rad_s) / RESISTANCE
        assert measured[2] == pytest.approx(inferred, abs=2e-3)


def test_current_comes_in_whole_steps_of_the_converter() -> None:
    held = plant(
        friction={"coulomb_n_m": 9.0, "static_n_m": 9.0}, current_sensor={"present": True, "resolution_a": 0.04}
    )
    for duty, wanted in ((0.3, 3.0), (0.3019, 3.0), (0.3021, 3.04), (-0.3021, -3.04)):
        assert held.advance(VOLTAGE, duty, 10)[2] == pytest.approx(wanted, rel=1e-12)


def test_eccentric_encoder_errs_once_a_turn() -> None:
    amplitude, phase = 0.05, 0.4
    turned = plant(eccentricity={"amplitude_rad": amplitude, "phase_rad": phase})
    errors = []
    for step in range(40):
        motor_rad = 2.0 * pi * step / 40.0
        turned.place(motor_rad / RATIO, motor_rad / RATIO)
        errors.append(float(turned.advance(VOLTAGE, 0.0, 0)[0]) * RATIO - motor_rad)
        wanted = amplitude * np.sin(motor_rad - phase)
        assert errors[-1] == pytest.approx(wanted, abs=1.01 * 2.0 * pi / 4096)
    assert max(errors) - min(errors) == pytest.approx(2.0 * amplitude, rel=0.05)
