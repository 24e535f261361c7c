"""The joint of a fitted model behind the drive contract."""

from math import nan, pi

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.control.drive_factory import Equipment
from bench.experiments.registry import find_kind, parse_parameters
from bench.runs.in_memory import InMemoryBench
from bench.study.suggestion.dynamics import Drive, Dynamics
from bench.study.suggestion.predict import Twin
from drivers.contract import Command, Mode

JOINT = Dynamics(
    drive=Drive(0.5, 0.0), inertia=0.004, load_inertia=1.0, gravity=0.1, load_gravity=1.0, offset=0.0, coulomb=0.03,
    viscous=0.02, excess=0.01, stribeck_rad_s=0.3, exponent=1.0, arm_m=0.2,
)  # fmt: skip


def test_friction_holds_what_it_can_hold():
    dry = JOINT.coulomb + JOINT.excess
    for share, moves in ((0.99, False), (1.01, True)):
        position, velocity = JOINT.step(0.0, 0.0, share * dry / 0.5, 0.0, 0.0, 0.001)
        assert (velocity != 0.0) == moves
        assert (position != 0.0) == moves


def test_a_steady_speed_balances_effort_and_friction():
    position, velocity = 0.0, 1.0
    flat = Dynamics(**{name: getattr(JOINT, name) for name in JOINT.__slots__} | {"gravity": 0.0})
    for _ in range(20000):
        position, velocity = flat.step(position, velocity, 0.2, 0.0, 0.0, 0.001)
    assert pytest.approx(flat.coulomb + flat.viscous * velocity, rel=1e-3) == 0.5 * 0.2


def test_a_pendulum_swings_with_its_own_period():
    free = Dynamics(
        **{name: getattr(JOINT, name) for name in JOINT.__slots__} | {"coulomb": 0.0, "excess": 0.0, "viscous": 0.0}
    )
    position, velocity, crossed, step_s = 0.02, 0.0, [], 0.0005
    for index in range(20000):
        before = position
        position, velocity = free.step(position, velocity, 0.0, 0.1, 0.1, step_s)
        if before < 0.0 <= position:
            crossed.append(index * step_s)
    inertia = 0.004 + 0.1 * 0.2**2
    weight = 0.1 + 0.1 * 9.80665 * 0.2
    assert np.mean(np.diff(crossed)) == pytest.approx(2 * pi * np.sqrt(inertia / weight), rel=0.01)


def test_experiments_run_on_it():
    configuration = default_configuration()
    kind = find_kind("excitation")
    values = {"waveforms": ["slow-sine"], "loads_kg": [0.05], "duration_s": 3.0, "speed_rad_s": 2.0, "repeats": 1}
    (plan,) = kind.plan(parse_parameters(kind, values), configuration)
    heavy = Dynamics(**{name: getattr(JOINT, name) for name in JOINT.__slots__} | {"drive": Drive(1.3, 0.0)})
    twin = Twin(heavy, configuration.rig, nan)
    with InMemoryBench(configuration, Equipment(twin, twin)) as bench:
        found = bench.record(plan, kind.name)
    assert found.conditions["load_kg"] == 0.05
    assert np.ptp(found.channels["position_rad"]) > 0.5
    assert "temperature_c" not in found.channels
    counts = configuration.rig.sensor.counts_per_turn * configuration.rig.gear.ratio
    turns = found.channels["position_rad"] * counts / (2 * pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-6)


def test_current_ends_where_the_supply_ends():
    rig = default_configuration().rig
    twin = Twin(JOINT, rig, 30.0)
    twin.open(0.005)
    twin.enable(Mode.CURRENT)
    sample = twin.exchange(Command(Mode.CURRENT, 1e6))
    assert sample.current_a == pytest.approx(rig.supply.voltage_v / rig.motor.resistance_ohm)
    assert sample.temperature_c == 30.0
    twin.disable()
    assert twin.exchange(Command(Mode.CURRENT, 1.0)).current_a == 0.0
