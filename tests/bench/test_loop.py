"""The control loop on a fake drive: every way to end, and the power is off."""

import math
import threading
from math import nan

import numpy as np
import pytest

from bench.control.clock import VirtualClock
from bench.control.limits import Guard, Limits
from bench.control.loop import OFF, RECORDED, Action, ControlLoop, Outcome
from bench.control.servo import CurrentServo
from bench.control.stop_request import StopRequest
from compensator.lab.recordings.channels import CHANNELS
from drivers.contract import Ages, Command, Mode, Status
from drivers.errors import DriveFault
from tests.bench.fake_drive import RIG, FakeDrive, ListSink

PERIOD_S = 0.005
PUSH = Action(Command(Mode.CURRENT, 0.1), target_rad=0.0)


def push(cycles=20, action=PUSH):
    reading = yield Action(OFF)
    for _ in range(cycles):
        reading = yield action
    return {"last_position_rad": reading.sample.position_rad}


def run(drive, procedure, stop=None, sink=None, limits=None, rig=RIG) -> tuple[Outcome, ListSink]:
    sink = sink or ListSink()
    drive.open(PERIOD_S)
    servo = CurrentServo(rig) if rig is not None else None
    loop = ControlLoop(drive, VirtualClock(), Guard(limits or Limits()), PERIOD_S, servo)
    outcome = loop.run(procedure, sink, stop or StopRequest())
    assert not drive.powered
    assert drive.calls[-1] == "disable"
    return outcome, sink


def rows_of(sink):
    return {name: np.vstack(sink.blocks)[:, index] for index, name in enumerate(RECORDED)}


def test_a_run_is_recorded_cycle_by_cycle():
    outcome, sink = run(FakeDrive(), push(20))
    rows = rows_of(sink)
    assert outcome == Outcome("completed", "", {"last_position_rad": 0.0}, cycles=21)
    np.testing.assert_allclose(rows["time_s"], PERIOD_S * np.arange(1, 22))
    np.testing.assert_allclose(rows["current_command_a"], [nan] + [0.1] * 20)
    np.testing.assert_allclose(rows["current_estimate_a"][1:], 0.1)
    np.testing.assert_allclose(rows["duty"][1:], 4.0 * 0.1 / 24.0)
    assert np.all(np.isnan(rows["current_a"]))
    assert list(rows["enabled"]) == [0.0] + [1.0] * 20


def test_every_recorded_channel_is_known_to_the_lab():
    assert set(RECORDED) <= set(CHANNELS)


def test_a_current_mode_of_the_drive_is_used():
    drive = FakeDrive(modes=frozenset({Mode.CURRENT}))
    run(drive, push(1))
    assert Command(Mode.CURRENT, 0.1) in drive.commands
    assert "enable current" in drive.calls


def test_without_current_mode_and_motor_constants_nothing_moves():
    drive = FakeDrive()
    outcome, _ = run(drive, push(1), rig=None)
    assert outcome.outcome == "failed"
    assert "resistance" in outcome.reason
    assert not any(call.startswith("enable") for call in drive.calls)


def test_velocity_is_derived_where_the_drive_has_none():
    drive = FakeDrive(alter=lambda cycle, sample: sample._replace(velocity_rad_s=nan, position_rad=0.01 * cycle))
    _, sink = run(drive, push(3, Action(OFF)))
    np.testing.assert_allclose(rows_of(sink)["velocity_rad_s"], 0.01 / PERIOD_S)


def test_events_are_recorded_in_order():
    _, sink = run(FakeDrive(), push(1, PUSH._replace(event=("mark", "here"))))
    assert [(name, detail) for _, name, detail in sink.events] == [("mark", "here"), ("end", "completed")]


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


@pytest.mark.parametrize(("wrong", "message"), TRIPS)
def test_each_limit_trips(wrong, message):
    drive = FakeDrive(alter=lambda cycle, sample: sample._replace(**wrong) if cycle == 10 else sample)
    outcome, sink = run(drive, push(1000))
    assert outcome.outcome == "tripped"
    assert message in outcome.reason
    assert outcome.cycles == 10
    assert "quick_stop" in drive.calls
    assert len(rows_of(sink)["time_s"]) == 11  # the sample that tripped is on record, and that of the braking


@pytest.mark.parametrize(("wrong", "message"), [trip for trip in TRIPS if "tracking" not in trip[1]])
def test_each_limit_is_checked_before_motion(wrong, message):
    drive = FakeDrive(alter=lambda _cycle, sample: sample._replace(**wrong))
    outcome, _ = run(drive, push(1000))
    assert outcome.outcome == "refused"
    assert message in outcome.reason
    assert not any(call.startswith("enable") for call in drive.calls)


def _stale_for(exchanges):
    return lambda cycle, sample: sample._replace(ages=Ages(supply_s=60.0)) if cycle < exchanges else sample


def test_a_drive_that_nobody_asked_for_a_while_is_asked_until_it_is_fresh():
    outcome, _ = run(FakeDrive(alter=_stale_for(20)), push())
    assert outcome.outcome == "completed"


def test_a_drive_that_stays_stale_is_refused():
    drive = FakeDrive(alter=_stale_for(100_000))
    outcome, _ = run(drive, push())
    assert outcome.outcome == "refused"
    assert outcome.reason.startswith("before motion: age of supply voltage, temperature or state is 60 s")
    assert drive.exchanges < 1000


def test_quantities_that_are_not_measured_do_not_trip():
    drive = FakeDrive(alter=lambda _cycle, sample: sample._replace(temperature_c=nan, current_a=nan))
    assert run(drive, push(5))[0].outcome == "completed"


def test_stop_is_honoured_within_one_cycle():
    stop = StopRequest()
    drive = FakeDrive(before=lambda cycle: stop.set() if cycle == 7 else None)
    outcome, _ = run(drive, push(1000), stop)
    assert (outcome.outcome, outcome.reason) == ("stopped", "stop was asked for")
    assert drive.commands[8:] == [OFF]  # the braking


def raise_at(cycle, error):
    """Raise once, as a signal does, or for good, as a fault does."""
    raised = []

    def before(now):
        if now >= cycle and not (raised and isinstance(error, KeyboardInterrupt)):
            raised.append(now)
            raise error

    return before


def test_a_fault_of_the_drive_ends_in_power_off():
    outcome, _ = run(FakeDrive(before=raise_at(5, DriveFault("fake", "over-current"))), push(1000))
    assert (outcome.outcome, outcome.reason) == ("failed", "drive 'fake': over-current")


def test_a_drive_that_switches_itself_off_is_noticed():
    drive = FakeDrive(alter=lambda cycle, s: s._replace(status=Status.DISABLED) if cycle == 5 else s)
    outcome, _ = run(drive, push(1000))
    assert outcome.outcome == "failed"
    assert "DISABLED during motion" in outcome.reason


def test_an_interrupt_from_the_keyboard_ends_in_power_off_and_stops_what_follows():
    stop = StopRequest()
    outcome, _ = run(FakeDrive(before=raise_at(5, KeyboardInterrupt())), push(1000), stop)
    assert (outcome.outcome, outcome.reason) == ("stopped", "interrupted from the keyboard")
    assert stop.is_set()


def test_what_is_no_exception_passes_through_but_powers_off():
    drive = FakeDrive(before=raise_at(5, SystemExit(3)))
    threads = threading.active_count()
    with pytest.raises(SystemExit):
        run(drive, push(1000))
    assert not drive.powered
    assert threading.active_count() == threads


def test_an_exception_of_the_procedure_ends_in_power_off():
    def procedure():
        yield Action(OFF)
        yield PUSH
        raise ZeroDivisionError("float division by zero")

    outcome, _ = run(FakeDrive(), procedure())
    assert (outcome.outcome, outcome.reason) == ("failed", "float division by zero")


def test_the_procedure_is_closed_when_it_is_cut_short():
    closed = []

    def procedure():
        try:
            while True:
                yield PUSH
        finally:
            closed.append(True)

    run(FakeDrive(before=raise_at(3, KeyboardInterrupt())), procedure())
    assert closed


@pytest.mark.parametrize("block", [0, 2])
def test_a_failing_sink_ends_in_power_off_and_keeps_what_came_before(block):
    sink = ListSink(fail_on_block=block)
    outcome, _ = run(FakeDrive(), push(200_000), sink=sink)
    assert outcome.outcome == "failed"
    assert outcome.reason == "the store failed: No space left on device"
    assert len(sink.blocks) == block
    assert outcome.cycles < 200_000


def test_a_sink_that_fails_on_the_last_block_is_not_a_completed_run():
    outcome, _ = run(FakeDrive(), push(3), sink=ListSink(fail_on_block=0))
    assert outcome.outcome == "failed"


def test_power_off_is_tried_again_when_it_is_interrupted():
    drive = FakeDrive(before=raise_at(5, KeyboardInterrupt()))
    disable, attempts = drive.disable, []

    def interrupted_once():
        attempts.append(True)
        if len(attempts) == 1:
            raise KeyboardInterrupt
        disable()

    drive.disable = interrupted_once
    outcome, _ = run(drive, push(1000))
    assert outcome.outcome == "stopped"
    assert "power-off failed: KeyboardInterrupt" in outcome.reason
    assert len(attempts) == 2


def test_a_failing_quick_stop_does_not_keep_the_power_on():
    drive = FakeDrive(before=raise_at(5, ValueError("boom")))
    drive.quick_stop = lambda: (_ for _ in ()).throw(OSError("port is gone"))
    outcome, _ = run(drive, push(1000))
    assert "boom" in outcome.reason
    assert "port is gone" in outcome.reason


def test_the_duty_never_leaves_its_range():
    drive = FakeDrive()
    run(drive, push(3, Action(Command(Mode.CURRENT, 1e3))), limits=Limits(current_a=1e4, speed_rad_s=1e4))
    assert max(abs(command.value) for command in drive.commands) == 1.0
    assert math.isfinite(drive.position_rad)
