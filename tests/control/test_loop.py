"""The control loop on fake drives, of one joint and of a pair: what is recorded, and what the limits do."""

import math
from math import nan

import numpy as np
import pytest

from bench.config.sections import Limits
from bench.control.cycle import OFF, Action
from bench.control.ending import Outcome
from drivers.contract import Ages, Command, Mode, Status
from tests.control.fake_drive import FakeDrive
from tests.control.loops import PERIOD_S, PUSH, on_each, push, run


@on_each
def test_a_run_is_recorded_cycle_by_cycle(setup):
    ran = run(setup, FakeDrive(), push(setup, 20))
    assert ran.outcome == Outcome("completed", "", {"last_position_rad": 0.0}, cycles=21)
    np.testing.assert_allclose(ran.rows["time_s"], PERIOD_S * np.arange(1, 22))
    np.testing.assert_allclose(ran.channel("current_command_a"), [nan] + [0.1] * 20)
    np.testing.assert_allclose(ran.channel("current_estimate_a")[1:], 0.1)
    np.testing.assert_allclose(ran.channel("duty")[1:], 4.0 * 0.1 / 24.0)
    assert np.all(np.isnan(ran.channel("current_a")))
    assert list(ran.channel("enabled")) == [0.0] + [1.0] * 20


@on_each
def test_a_current_mode_of_the_drive_is_used(setup):
    drive = FakeDrive(modes=frozenset({Mode.CURRENT}))
    run(setup, drive, push(setup, 1))
    assert Command(Mode.CURRENT, 0.1) in drive.commands
    assert "enable current" in drive.calls


@on_each
def test_without_current_mode_and_motor_constants_nothing_moves(setup):
    ran = run(setup, FakeDrive(), push(setup, 1), rig=None)
    assert ran.outcome.outcome == "failed"
    assert ran.outcome.reason.startswith(f"{setup.prefix}the drive has no current mode, and the rig lacks the resist")
    for drive in ran.drives.values():
        assert not any(call.startswith("enable") for call in drive.calls)


@on_each
def test_velocity_is_derived_where_the_drive_has_none(setup):
    drive = FakeDrive(alter=lambda cycle, sample: sample._replace(velocity_rad_s=nan, position_rad=0.01 * cycle))
    ran = run(setup, drive, push(setup, 3, Action(OFF)))
    np.testing.assert_allclose(ran.channel("velocity_rad_s"), 0.01 / PERIOD_S)


@on_each
def test_events_are_recorded_in_order(setup):
    ran = run(setup, FakeDrive(), push(setup, 1, PUSH._replace(event=("mark", "here"))))
    assert [(name, detail) for _, name, detail in ran.sink.events] == [("mark", "here"), ("end", "completed")]


@on_each
def test_a_change_of_mode_that_the_drive_need_not_know_of_switches_nothing(setup):
    def procedure():
        yield setup.action(PUSH)
        yield setup.action(Action(Command(Mode.DUTY, 0.01)))
        yield setup.action(PUSH)

    drive = FakeDrive()
    assert run(setup, drive, procedure()).outcome.outcome == "completed"
    assert [call for call in drive.calls if call.startswith("enable")] == ["enable duty"]


TRIPS = [
    ({"position_rad": 2.5}, "position is 2.5 rad; allowed is -2.2 .. 2.2 rad"),
    ({"position_rad": nan}, "position is nan rad"),
    ({"velocity_rad_s": -9.0}, "speed is -9 rad/s; allowed is -8 .. 8 rad/s"),
    ({"current_a": 2.5}, "motor current is 2.5 A; allowed is -2 .. 2 A"),
    ({"temperature_c": 90.0}, "temperature is 90 degC; allowed is at most 80 degC"),
    ({"position_rad": -0.6}, "tracking error is 0.6 rad; allowed is -0.5 .. 0.5 rad"),
    ({"age_s": 0.2}, "age of the sample is 0.2 s; allowed is at most 0.1 s"),
    ({"age_s": nan}, "age of the sample is nan s"),
    ({"ages": Ages(status_s=3.0)}, "age of supply voltage, temperature or state is 3 s; allowed is at most 2 s"),
]


@on_each
@pytest.mark.parametrize(("wrong", "message"), TRIPS)
def test_each_limit_trips(setup, wrong, message):
    drive = FakeDrive(alter=lambda cycle, sample: sample._replace(**wrong) if cycle == 10 else sample)
    ran = run(setup, drive, push(setup, 1000))
    assert ran.outcome.outcome == "tripped"
    assert ran.outcome.reason.startswith(f"{setup.prefix}{message}")
    assert ran.outcome.cycles == 10
    for one in ran.drives.values():
        assert one.calls[-2:] == ["quick_stop", "disable"]
    assert len(ran.rows["time_s"]) == 11  # the sample that tripped is on record, and that of the braking


@on_each
def test_a_drive_that_brakes_for_too_long_is_told(setup):
    drive = FakeDrive(alter=_brakes_from(10))
    ran = run(setup, drive, push(setup, 1000))
    assert f"; {setup.prefix}the drive still braked 0.5 s after the stop, and its power" in ran.outcome.reason
    assert drive.calls[-2:] == ["quick_stop", "disable"]
    assert len(ran.rows["time_s"]) == 10 + 0.5 / PERIOD_S


def _brakes_from(exchange):
    """A limit is passed, and the drive brakes on."""
    return lambda cycle, sample: (
        sample._replace(current_a=2.5, status=Status.QUICK_STOP) if cycle >= exchange else sample
    )


@on_each
@pytest.mark.parametrize(("wrong", "message"), [trip for trip in TRIPS if "tracking" not in trip[1]])
def test_each_limit_is_checked_before_motion(setup, wrong, message):
    drive = FakeDrive(alter=lambda _cycle, sample: sample._replace(**wrong))
    ran = run(setup, drive, push(setup, 1000))
    assert ran.outcome.outcome == "refused"
    assert ran.outcome.reason.startswith(f"before motion: {setup.prefix}{message}")
    assert not ran.sink.blocks
    for one in ran.drives.values():
        assert not any(call.startswith("enable") for call in one.calls)


def _stale_for(exchanges):
    return lambda cycle, sample: sample._replace(ages=Ages(supply_s=60.0)) if cycle < exchanges else sample


@on_each
def test_a_drive_that_nobody_asked_for_a_while_is_asked_until_it_is_fresh(setup):
    ran = run(setup, FakeDrive(alter=_stale_for(20)), push(setup))
    assert ran.outcome.outcome == "completed"
    assert ran.rows["time_s"][0] == pytest.approx(PERIOD_S)  # the trial begins with the fresh sample


def _old_until(exchanges):
    """As after the silence in which a watchdog of 1 s is tried: 2 s are allowed."""
    return lambda cycle, sample: sample._replace(
        ages=Ages(supply_s=1.9 + PERIOD_S * cycle if cycle < exchanges else PERIOD_S * (cycle - exchanges))
    )


@on_each
def test_what_is_nearly_too_old_is_asked_for_before_motion(setup):
    ran = run(setup, FakeDrive(alter=_old_until(60)), push(setup))
    assert ran.outcome.outcome == "completed", ran.outcome.reason


@on_each
def test_a_drive_that_stays_stale_is_refused(setup):
    drive = FakeDrive(alter=_stale_for(100_000))
    ran = run(setup, drive, push(setup))
    assert ran.outcome.outcome == "refused"
    old = "age of supply voltage, temperature or state is 60 s"
    assert ran.outcome.reason.startswith(f"before motion: {setup.prefix}{old}")
    assert drive.exchanges < 1000


@on_each
def test_quantities_that_are_not_measured_do_not_trip(setup):
    drive = FakeDrive(alter=lambda _cycle, sample: sample._replace(temperature_c=nan, current_a=nan))
    assert run(setup, drive, push(setup, 5)).outcome.outcome == "completed"


@on_each
def test_the_duty_never_leaves_its_range(setup):
    drive = FakeDrive()
    limits = Limits(current_a=1e4, speed_rad_s=1e4)
    run(setup, drive, push(setup, 3, Action(Command(Mode.CURRENT, 1e3))), limits=limits)
    assert max(abs(command.value) for command in drive.commands) == 1.0
    assert math.isfinite(drive.position_rad)
