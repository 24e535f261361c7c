"""Power stage, supply and motor as they really are: sag, dead time, cogging, heat, I2t."""

from math import cos, pi
from typing import Any

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveFault
from sim_backend.drive.simulated_drive import SimulatedDrive
from sim_backend.mechanisms.motor.motor import CURRENT, OPEN, VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters
from tests.sim_backend.plants import RATIO, RESISTANCE, ROTOR, SUPPLY, K, duty_for_torque, plant, run, settled_speed

HELD = {"coulomb_n_m": 9.0, "static_n_m": 9.0}
DEAD = {"time_s": 2e-6, "frequency_hz": 20e3}
LOST_V = SUPPLY * 2e-6 * 20e3
SENSED: dict[str, Any] = {"current_sensor": {"present": True}, "current_loop": {"present": True}}


@pytest.mark.parametrize("duty", [0.5, -1.0])
def test_stalled_motor_sags_the_supply_by_what_it_draws(duty: float) -> None:
    held = plant(friction=HELD, supply={"source_resistance_ohm": 0.6})
    measured = held.advance(VOLTAGE, duty, 100)
    current = duty * SUPPLY / (RESISTANCE + 0.6 * duty**2)
    assert held.truth().current_a == pytest.approx(current, rel=1e-12)
    assert measured[4] == pytest.approx(SUPPLY - 0.6 * duty * current, rel=1e-12)
    energy = held.energy()
    assert energy.lost_j == pytest.approx(SUPPLY * duty * current * 0.01, rel=1e-9)
    assert energy.supplied_j == pytest.approx(energy.lost_j, rel=1e-12)


def test_braking_motor_raises_the_supply() -> None:
    braking = plant(supply={"source_resistance_ohm": 0.6})
    settled_speed(braking, 0.8)
    measured = braking.advance(VOLTAGE, 0.2, 1)
    assert measured[4] > SUPPLY


def test_current_loop_gets_no_more_voltage_than_a_sagging_supply_has() -> None:
    held = plant(friction=HELD, supply={"source_resistance_ohm": 0.5}, **SENSED)
    held.advance(CURRENT, 20.0, 1000)
    assert held.truth().current_a == pytest.approx(SUPPLY / (RESISTANCE + 0.5), rel=1e-9)


def test_current_loop_closes_on_what_its_sensor_says() -> None:
    loop = SENSED | {"current_sensor": {"present": True, "gain": 1.1, "offset_a": 0.05}}
    held = plant(friction=HELD, **loop)
    measured = held.advance(CURRENT, 0.6, 1000)
    assert measured[2] == pytest.approx(0.6, rel=1e-9)
    assert held.truth().current_a == pytest.approx((0.6 - 0.05) / 1.1, rel=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_dead_time_takes_its_voltage_against_the_current(sign: float) -> None:
    held = plant(friction=HELD, dead_time=DEAD)
    held.advance(VOLTAGE, sign * 0.9 * LOST_V / SUPPLY, 100)
    assert held.truth().current_a == 0.0
    held.advance(VOLTAGE, sign * 0.3, 100)
    assert held.truth().current_a == pytest.approx(sign * (0.3 * SUPPLY - LOST_V) / RESISTANCE, rel=1e-12)
    energy = held.energy()
    assert energy.lost_j == pytest.approx(0.3 * SUPPLY * abs(held.truth().current_a) * 0.01, rel=1e-9)


def test_dead_time_lowers_the_terminal_speed() -> None:
    spinning = plant(dead_time=DEAD, friction={"coulomb_n_m": 1e-3, "static_n_m": 1e-3})
    wanted = (0.5 * SUPPLY - LOST_V - RESISTANCE * 1e-3 / K) / K
    assert settled_speed(spinning, 0.5, 10.0) * RATIO == pytest.approx(wanted, rel=1e-6)


def test_cogging_holds_the_rotor_up_to_its_amplitude() -> None:
    for factor, turns in ((0.99, False), (1.05, True)):
        cogged = plant(
            gear={"backlash_rad": 6.0}, cogging={"amplitude_n_m": 5e-3, "cycles_per_turn": 12.0},
            friction={"viscous_n_m_s_rad": 2e-3},
        )  # fmt: skip
        cogged.place(pi / 12.0 / RATIO, 0.0)  # a stable place: the torque falls through 0
        for share in range(1, 101):
            run(cogged, duty_for_torque(RATIO * 5e-3 * factor * share / 100.0), 0.02)
        run(cogged, duty_for_torque(RATIO * 5e-3 * factor), 5.0)
        assert (cogged.truth().rotor_rad * RATIO > 2.0 * pi / 12.0) is turns


def test_rotor_swings_in_a_cog_with_the_frequency_of_theory_and_keeps_its_energy() -> None:
    cogged = plant(gear={"backlash_rad": 6.0}, cogging={"amplitude_n_m": 5e-3, "cycles_per_turn": 12.0})
    swing = 0.002
    cogged.place((pi / 12.0 + swing) / RATIO, 0.0)
    began = cogged.energy().stored_j
    assert began == pytest.approx(0.5 * 12.0 * 5e-3 * swing**2, rel=1e-3)
    period_s = 2.0 * pi / (12.0 * 5e-3 / ROTOR) ** 0.5
    cogged.advance(OPEN, 0.0, round(2.0 * period_s / 1e-4))
    phase = 2.0 * pi * round(2.0 * period_s / 1e-4) * 1e-4 / period_s
    assert cogged.truth().rotor_rad * RATIO - pi / 12.0 == pytest.approx(swing * cos(phase), abs=0.01 * swing)
    assert cogged.energy().stored_j == pytest.approx(began, rel=1e-2)


def test_warm_copper_resists_more_and_warm_magnets_pull_less() -> None:
    drift = {"resistance_per_k": 0.0039, "torque_constant_per_k": 0.002, "reference_c": 25.0}
    held = plant(friction=HELD, thermal_drift=drift, heat={"start_c": 75.0})
    held.advance(VOLTAGE, 0.5, 10)
    assert held.truth().current_a == pytest.approx(0.5 * SUPPLY / (RESISTANCE * (1.0 + 0.0039 * 50.0)), rel=1e-12)
    spinning = plant(thermal_drift=drift, heat={"start_c": 75.0})
    assert settled_speed(spinning, 0.5) * RATIO == pytest.approx(0.5 * SUPPLY / (K * (1.0 - 0.1)), rel=1e-6)


def test_stalled_motor_that_warms_draws_less_and_less() -> None:
    warming = plant(
        friction=HELD, thermal_drift={"resistance_per_k": 0.0039},
        heat={"present": True, "winding_j_k": 2.0, "winding_to_housing_k_w": 1e9},
    )  # fmt: skip
    run(warming, 0.3, 10.0)
    # all heat stays: R dR = a R0 u^2 / C dt
    final = RESISTANCE * (1.0 + 2.0 * 0.0039 * (0.3 * SUPPLY) ** 2 / RESISTANCE / 2.0 * 10.0) ** 0.5
    assert warming.truth().current_a == pytest.approx(0.3 * SUPPLY / final, rel=1e-4)


def _drive(**overload: float) -> SimulatedDrive:
    tables = SENSED | {"friction": HELD, "overload": {"present": True} | overload}
    drive = SimulatedDrive(PlantParameters.from_dict(tables, presets.paper()))
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    return drive


@pytest.mark.parametrize(("current_a", "after_s"), [(2.0, 0.5), (1.5, 1.2), (0.99, None)])
def test_i2t_allows_the_peak_for_its_time_and_less_for_longer(current_a: float, after_s: float | None) -> None:
    drive = _drive(continuous_a=1.0, peak_a=2.0, peak_time_s=0.5)
    for _ in range(1000):
        sample = drive.exchange(Command(Mode.CURRENT, current_a))
        if sample.status is Status.FAULT:
            break
    if after_s is None:
        assert sample.status is Status.ENABLED
        return
    # the current takes a few time constants of its loop to rise
    assert sample.time_s == pytest.approx(after_s, abs=0.0101)
    with pytest.raises(DriveFault, match=r"switched itself off: I2t overload, .* A; find the cause"):
        drive.exchange(Command(Mode.CURRENT, current_a))
    drive.exchange(Command(Mode.OFF))
    assert drive.plant.truth().current_a == 0.0


def test_drive_demands_no_more_than_the_peak_current() -> None:
    drive = _drive(continuous_a=1.0, peak_a=2.0, peak_time_s=0.5)
    for _ in range(20):
        sample = drive.exchange(Command(Mode.CURRENT, -2.9))
    assert sample.current_a == pytest.approx(-2.0, rel=1e-6)


def test_i2t_recovers_at_rest() -> None:
    drive = _drive(continuous_a=1.0, peak_a=2.0, peak_time_s=0.5)
    for _ in range(6):
        for _ in range(60):
            drive.exchange(Command(Mode.CURRENT, 2.0))
        for _ in range(300):
            sample = drive.exchange(Command(Mode.CURRENT, 0.0))
    assert sample.status is Status.ENABLED
