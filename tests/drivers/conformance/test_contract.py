"""What every drive does alike: the contract, on each driver and on the in-process simulation."""

import time
from math import inf, isnan, nan

import pytest

from bench.runs.watchdog_proof import prove_watchdog
from drivers.contract import Command, Mode, Status, Watchdog
from drivers.errors import DriveConfigurationError, DriveError, DriveFault, DriveStateError
from tests.drivers.conformance.benches import ADAPTER, PERIOD_S, PORTS, TCP

OFF = Command(Mode.OFF)
PUSHES = {Mode.DUTY: 0.15, Mode.CURRENT: 0.3, Mode.TORQUE: 0.015}  # enough to move the joint without load, gently


def push_mode(drive):
    return next(mode for mode in PUSHES if mode in drive.describe().modes)


def cycles(drive, command, count):
    samples = []
    for _ in range(count):
        time.sleep(PERIOD_S)
        samples.append(drive.exchange(command))
    return samples


@pytest.mark.real_wire
def test_it_says_who_it_is_and_what_it_can(bench):
    with bench.opened() as drive:
        found = drive.describe()
    assert found.device
    assert found.vendor
    assert found.product
    assert bool(found.firmware) is bench.variant.tells_firmware
    assert found.modes & set(PUSHES)
    assert found.max_rate_hz >= 1.0 / PERIOD_S
    if bench.variant.has_watchdog:
        assert found.watchdog_s > PERIOD_S
    else:  # and nobody runs it unknowingly
        assert found.watchdog_s is None
        assert found.watchdog is Watchdog.NONE
        assert any("no watchdog" in note.lower() for note in found.notes)
    assert found.simulated  # no record of a simulated device may be taken for one of hardware
    assert "position_rad" in found.measured
    assert found.resolution["position_rad"] == pytest.approx(7.67e-5, rel=1e-3)
    assert found.longest_call_s < 10.0


@pytest.mark.real_wire
def test_a_sample_has_what_is_measured_and_nan_for_the_rest(bench):
    with bench.opened() as drive:
        samples = cycles(drive, OFF, 20)
        measured = drive.describe().measured
    for sample in samples:
        assert sample.status is Status.DISABLED
        assert sample.age_s >= 0.0
        assert all(age_s >= 0.0 for age_s in sample.ages)
        assert abs(sample.position_rad) < 0.5
        for name in ("velocity_rad_s", "duty", "current_a", "supply_v", "temperature_c"):
            assert isnan(getattr(sample, name)) is (name not in measured), name
    # a sample may be handed over twice where the next one is late
    times_s = [sample.time_s for sample in samples]
    assert times_s == sorted(times_s)
    assert times_s[-1] > times_s[0]


def test_si_units(bench):
    with bench.opened() as drive:
        sample = cycles(drive, OFF, 5)[-1]
        measured = drive.describe().measured
    if "supply_v" in measured:
        assert sample.supply_v == pytest.approx(24.0, abs=0.2)
    if "temperature_c" in measured:
        assert 15.0 < sample.temperature_c < 45.0


@pytest.mark.real_wire
def test_a_positive_demand_turns_the_joint_to_positive_angles(bench):
    with bench.opened() as drive:
        mode = push_mode(drive)
        start_rad = drive.exchange(OFF).position_rad
        drive.enable(mode)
        samples = cycles(drive, Command(mode, PUSHES[mode]), 20)
        drive.disable()
        measured = drive.describe().measured
    assert samples[-1].status is Status.ENABLED
    assert samples[-1].position_rad - start_rad > 0.01
    if "velocity_rad_s" in measured:
        assert max(sample.velocity_rad_s for sample in samples) > 0.05
    if "current_a" in measured:
        assert sum(sample.current_a for sample in samples) > 0.0
    if "duty" in measured:
        assert samples[-1].duty > 0.0


def test_disable_takes_the_power_away(bench):
    with bench.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        assert cycles(drive, Command(mode, PUSHES[mode]), 3)[-1].status is Status.ENABLED
        drive.disable()
        assert cycles(drive, OFF, 3)[-1].status is Status.DISABLED
        if bench.device is not None:
            bench.device.wait_for_power(False)
        drive.enable(mode)
        cycles(drive, Command(mode, PUSHES[mode]), 2)
        # an OFF command alone does it too
        assert cycles(drive, OFF, 5)[-1].status is Status.DISABLED
        if bench.device is not None:
            bench.device.wait_for_power(False)


def test_a_quick_stop_ends_in_power_off(bench):
    with bench.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        cycles(drive, Command(mode, PUSHES[mode]), 20)
        drive.quick_stop()
        statuses = [sample.status for sample in cycles(drive, OFF, 60)]
        drive.disable()
    assert statuses[-1] is Status.DISABLED
    assert Status.ENABLED not in statuses[1:]


@pytest.mark.real_wire(*PORTS)
def test_closing_takes_the_power_away_and_it_opens_again(bench):
    with bench.drive() as drive:
        for _ in range(2):
            drive.open(PERIOD_S)
            mode = push_mode(drive)
            drive.enable(mode)
            cycles(drive, Command(mode, PUSHES[mode]), 3)
            drive.close()
            drive.close()
            if bench.device is not None:
                bench.device.wait_for_power(False)


def test_any_time_may_pass_while_it_is_disabled(bench):
    with bench.opened() as drive:
        mode = push_mode(drive)
        for _ in range(2):
            drive.enable(mode)
            assert cycles(drive, Command(mode, 0.0), 3)[-1].status is Status.ENABLED
            drive.disable()
            time.sleep(2.0 * bench.watched_s)


@pytest.mark.parametrize("value", [nan, inf, 1e9])
def test_an_impossible_demand_is_refused(bench, value):
    with bench.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        if bench.name == "sim" and mode is Mode.CURRENT and value == 1e9:
            pytest.skip("the simulated drive limits a current")
        with pytest.raises(DriveConfigurationError):
            drive.exchange(Command(mode, value))


def test_a_mode_that_it_does_not_have_is_refused(bench):
    with bench.opened() as drive:
        for mode in {Mode.DUTY, Mode.CURRENT, Mode.TORQUE, Mode.POSITION} - drive.describe().modes:
            with pytest.raises(DriveConfigurationError, match=mode.value):
                drive.enable(mode)


def test_motion_needs_to_be_enabled(bench):
    with bench.opened() as drive:
        mode = push_mode(drive)
        with pytest.raises(DriveStateError):
            drive.exchange(Command(mode, 0.0))


def test_calls_before_opening_are_refused(bench):
    with bench.drive() as drive:
        for call in (
            lambda: drive.exchange(OFF),
            lambda: drive.enable(Mode.DUTY),
            drive.quick_stop,
            drive.clear_fault,
            drive.inspect,
        ):
            with pytest.raises(DriveStateError, match="open"):
                call()
        drive.close()


def test_a_watchdog_shorter_than_the_period_is_refused(bench):
    if not bench.variant.has_watchdog:
        pytest.skip("it has no watchdog")
    with bench.drive() as drive, pytest.raises(DriveConfigurationError):
        drive.open(10.0)


def knows_that_it_is_off(drive, command):
    """Whether the driver says so, by its status or by an error, within a few cycles."""
    try:
        return any(sample.status is not Status.ENABLED for sample in cycles(drive, command, 20))
    except (DriveFault, DriveStateError):
        return True


@pytest.mark.real_wire("roboclaw", *ADAPTER, *TCP)  # whose watchdog it is, is the same in virtual time
def test_a_silent_host_is_switched_off_by_the_drive_itself(watched):
    with watched.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        before_s = time.monotonic()
        while not watched.device.truth()["powered"]:
            before_s = time.monotonic()
            drive.exchange(Command(mode, PUSHES[mode]))
        off_s = watched.device.wait_for_power(False)
        # the drive's own time: no other process has to be quick
        assert watched.watched_s * 0.5 < off_s - before_s < watched.watched_s + 0.3
        assert knows_that_it_is_off(drive, Command(mode, PUSHES[mode]))


def test_what_it_says_of_itself_when_nothing_is_written(bench):
    with bench.opened() as drive:
        assert drive.inspect().status in (Status.DISABLED, None)  # not every drive tells its state
        assert drive.inspect().fault == ""
        mode = push_mode(drive)
        drive.enable(mode)
        cycles(drive, Command(mode, PUSHES[mode]), 5)
        found = drive.inspect()
        assert found.status in (Status.ENABLED, None)
        if mode is Mode.DUTY and not isnan(found.duty):
            assert found.duty == pytest.approx(PUSHES[mode], abs=1e-3)


def test_a_watchdog_that_ran_out_is_seen_before_anything_is_written(watched):
    with watched.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        cycles(drive, Command(mode, PUSHES[mode]), 2)
        time.sleep(1.5 * watched.watched_s)
        found = drive.inspect()
        assert not watched.device.truth()["powered"]
        assert found.status is not Status.ENABLED
        assert isnan(found.duty) or found.duty == 0.0


def without_limits(configuration):
    limits = configuration.limits.model_copy(update={"position_min_rad": -1e3, "position_max_rad": 1e3})
    return configuration.model_copy(update={"limits": limits})


def test_the_watchdog_is_proven_at_the_drive(watched):
    with watched.opened() as drive:
        found = prove_watchdog(drive, without_limits(watched.configuration))  # earlier tests have turned the joint
        assert found.watchdog is Watchdog.PROVEN, found.sentence
    watched.device.wait_for_power(False)


def test_a_host_that_was_lost_leaves_nothing_for_the_next_one_to_clear(wired):
    """As after a host that was killed, and as `friction-bench doctor --move` goes on after its test of the watchdog."""
    with wired.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        drive.exchange(Command(mode, 0.0))
        time.sleep(1.5 * wired.watched_s)
    with wired.opened() as drive:
        drive.enable(mode)
        assert cycles(drive, Command(mode, 0.0), 3)[-1].status is Status.ENABLED


def test_errors_are_of_one_tree():
    assert issubclass(DriveFault, DriveError)
