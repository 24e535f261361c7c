from math import pi

import numpy as np
import pytest

from sim_backend.mechanisms.motor.motor import CURRENT, VOLTAGE
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import RESISTANCE, SUPPLY, plant

RIPPLE = {"fraction": 0.1, "frequency_hz": 5.0}


def _held(**tables: dict[str, float]) -> Plant:
    """A motor that cannot turn: its current is the voltage's."""
    return plant(friction={"coulomb_n_m": 1.0, "static_n_m": 1.0}, current_sensor={"present": True}, **tables)


def _currents(joint: Plant, stage: int, demand: float) -> np.ndarray:
    return np.array([joint.advance(stage, demand, 10)[2] for _ in range(1000)])


def test_current_of_a_held_motor_ripples_and_the_drive_says_nothing_of_it() -> None:
    joint = _held(supply_ripple=RIPPLE)
    current = _currents(joint, VOLTAGE, 0.5)
    time_s = 1e-3 * np.arange(1, 1001)
    wanted = 0.5 * SUPPLY / RESISTANCE * (1.0 + 0.1 * np.sin(2.0 * pi * 5.0 * (time_s - 1e-4)))
    assert current == pytest.approx(wanted, rel=1e-6)
    assert joint.advance(VOLTAGE, 0.5, 10)[4] == SUPPLY


def test_a_drive_that_controls_its_current_makes_up_for_it() -> None:
    joint = _held(supply_ripple=RIPPLE, current_loop={"present": True})
    current = _currents(joint, CURRENT, 1.0)
    assert current[100:] == pytest.approx(1.0, abs=1e-9)
