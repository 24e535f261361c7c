"""Position servo and current servo."""

from contextlib import suppress
from math import nan

import pytest

from bench.config.configuration import default_configuration
from bench.config.rig import Gear, Motor, Rig
from bench.config.sections import ServoSettings
from bench.control.cycle import Reading
from bench.control.servo import CurrentServo, PositionServo, current_servo
from bench.errors import ConfigurationError
from bench.experiments.parts.joint import Joint
from drivers.contract import Command, Mode, Sample, Status
from tests.control.fake_drive import RIG

SETTINGS = ServoSettings(
    proportional_a_rad=10.0, integral_a_rad_s=100.0, derivative_a_s_rad=0.5, dead_band_rad=0.01, current_a=1.0
)
SAMPLE = Sample(0.0, 0.0, 0.0, 2.0, 0.5, nan, 24.0, nan, Status.ENABLED)


def test_pid_by_hand():
    servo = PositionServo(SETTINGS, period_s=0.01)
    # integral 100 * 0.05 * 0.01, proportional 10 * 0.05, derivative 0.5 * (0.2 - 0.4)
    assert servo.current_a(0.05, 0.0, 0.4, 0.2) == pytest.approx(0.05 + 0.5 - 0.1)


def test_in_the_dead_band_the_current_stands():
    servo = PositionServo(SETTINGS, period_s=0.01)
    servo.reset(0.3)
    assert [servo.current_a(0.009, 0.0, 0.0) for _ in range(5)] == [pytest.approx(0.3)] * 5


def test_output_is_limited_and_the_integral_does_not_wind_up():
    servo = PositionServo(SETTINGS, period_s=0.01)
    for _ in range(1000):
        assert servo.current_a(1.0, 0.0, 0.0) == 1.0
    # back within two cycles of the error's change of sign
    assert servo.current_a(-0.11, 0.0, 0.0) < 0.0


def test_current_servo_by_hand():
    servo = CurrentServo(RIG)
    # (24 * 0.5 - 0.02 * 2 rad/s * 50) / 4
    assert servo.estimate_a(SAMPLE, 2.0) == pytest.approx(2.5)
    assert servo.duty(2.5, SAMPLE, 2.0) == pytest.approx(0.5)
    assert servo.duty(1e3, SAMPLE, 2.0) == 1.0


def test_an_unmeasured_supply_is_the_rigs():
    servo = CurrentServo(RIG)
    assert servo.estimate_a(SAMPLE._replace(supply_v=nan), 2.0) == pytest.approx(2.5)


def test_a_warm_winding_takes_more_duty_and_gives_less_current():
    motor = Motor(resistance_ohm=8.0, back_emf_v_s_rad=0.05, constants_at_c=25.0)
    servo = CurrentServo(Rig(name="r", motor=motor, gear=Gear(ratio=20.0)))
    cold, warm = (SAMPLE._replace(temperature_c=celsius, supply_v=24.0) for celsius in (25.0, 75.0))
    ratio = 1.0 + 0.00393 * 50.0
    assert servo.estimate_a(warm, 0.0) == pytest.approx(servo.estimate_a(cold, 0.0) / ratio)
    assert servo.duty(0.5, warm, 0.0) == pytest.approx(servo.duty(0.5, cold, 0.0) * ratio)


def test_without_a_temperature_the_constants_of_the_rig_hold():
    motor = Motor(resistance_ohm=8.0, back_emf_v_s_rad=0.05, constants_at_c=25.0)
    known = CurrentServo(Rig(name="r", motor=motor, gear=Gear(ratio=20.0)))
    plain = CurrentServo(Rig(name="r", motor=Motor(resistance_ohm=8.0, back_emf_v_s_rad=0.05), gear=Gear(ratio=20.0)))
    unmeasured = SAMPLE._replace(temperature_c=nan, supply_v=24.0)
    assert known.estimate_a(unmeasured, 0.1) == plain.estimate_a(unmeasured, 0.1)
    assert plain.estimate_a(SAMPLE._replace(temperature_c=75.0), 0.1) == plain.estimate_a(SAMPLE, 0.1)


def test_a_supply_that_nobody_knows_is_asked_for():
    rig = Rig(name="r", motor=Motor(resistance_ohm=1, back_emf_v_s_rad=1), gear=Gear(ratio=1))
    with pytest.raises(ConfigurationError, match=r"supply.voltage_v \[V\]"):
        CurrentServo(rig).estimate_a(SAMPLE._replace(supply_v=nan), 0.0)


def test_a_rig_without_motor_constants_has_no_current_servo():
    rig = Rig(name="bare")
    assert current_servo(rig) is None
    with pytest.raises(ConfigurationError, match=r"rig 'bare'.*resistance_ohm"):
        CurrentServo(rig)


def test_a_drive_that_closes_the_position_loop_is_given_positions():
    configuration = default_configuration()
    settings = configuration.servo.model_copy(update={"closed_by": "drive"})
    joint = Joint(configuration.model_copy(update={"servo": settings}))
    at_rest = Sample(0.0, 0.0, 0.5, 0.0, nan, 0.3, nan, nan, Status.ENABLED)
    reading = Reading(0.0, at_rest, 0.0, 0.3)
    found = []

    def procedure():
        yield from joint.wake()
        found.append((yield from joint.settle(0.5)))

    running = procedure()
    next(running)
    commands = []
    with suppress(StopIteration):
        while True:
            commands.append(running.send(reading).command)
    assert set(commands) == {Command(Mode.POSITION, 0.5)}
    assert found[0].current_a == pytest.approx(0.3)
