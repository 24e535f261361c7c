"""Drives whose ramps are slow as delivered stop soon all the same, whoever stops them; or `doctor` tells."""

import time
from math import pi

import pytest

from bench.config.sections import Limits
from bench.control.clock import WallClock
from bench.control.cycle import OFF, Action
from bench.control.ending import StopRequest
from bench.control.late_cycles import BRAKING_S
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from drivers.canopen.cia402.stopping import RAMP_S
from drivers.contract import Command, Mode
from sim_backend.devices.canopen.emergency import ErrorCode
from sim_backend.devices.canopen.objects.entry import Access
from tests.control.fake_drive import ListSink
from tests.drivers.dictionaries.attempt import PERIOD_S, RATED_A, WATCHDOG_S, cycles, device, host
from tests.drivers.dictionaries.traits import Trait

pytestmark = pytest.mark.virtual_time
RAMP, UNIT, QUICK_STOP, FAULT_REACTION, LOST_HOST = 0x6085, 0x60AA, (0x605A, 0), (0x605E, 0), 0x6007
SLOW = {(RAMP, 0): 200}  # counts/s2: minutes
HELD = {(RAMP, 0): Access.RO, QUICK_STOP: Access.RO, FAULT_REACTION: Access.RO}
DRIVES = {
    "slow-ramp": Trait(default=SLOW),
    "slow-ramp-without-unit": Trait(default=SLOW, without=(UNIT,)),
    "slow-ramp-that-stays": Trait(default=SLOW, access={(RAMP, 0): Access.RO}),
    "no-velocity-unit": Trait(default=SLOW | {(0x60A9, 0): 0}, without=(UNIT,)),
    "nothing-to-be-set": Trait(default=SLOW, access=HELD),
    "steep-without-unit": Trait(default={(RAMP, 0): 2_000_000_000}, without=(UNIT,)),
    "no-ramp-object": Trait(without=(RAMP,)),
    "no-reaction-to-a-lost-host": Trait(default=SLOW, without=(LOST_HOST,)),
}
LIMITS = {"position_min_rad": -1e3, "position_max_rad": 1e3, "tracking_error_rad": 1e3, "sample_age_s": 1.0}
SPEED_RAD_S = 4.0
COASTS_RAD = 1.1  # under friction alone, from that speed
RESET_S = 0.75  # until a drive that brakes on in a fault is reset


def at_speed(reading):
    """A current that brings the joint to the speed, and keeps it there."""
    ramp = min(reading.time_s / 0.4, 1.0) * SPEED_RAD_S
    return Action(Command(Mode.CURRENT, 0.25 + 0.4 * (ramp - reading.velocity_rad_s)))


def stopped(running, drive, cause):
    """Time from the cause to power-off and standstill [s], the way [rad], and what the run says."""
    axis, stop = running.device.axis, StopRequest()
    guard = Guard(Limits(**LIMITS))
    begun = []

    def procedure():
        reading = yield Action(OFF)
        while True:
            reading = yield at_speed(reading)
            if reading.time_s > 0.8 and not begun:
                begun.extend((axis.time_s, axis.seen.position_rad))
                if cause == "fault":
                    running.device._fault(ErrorCode.FOLLOWING_ERROR)
                elif cause == "limit":
                    guard._bounds = (*guard._bounds[:2], 0.5 * SPEED_RAD_S, *guard._bounds[3:])
                    guard.limits = guard.limits.model_copy(update={"speed_rad_s": 0.5 * SPEED_RAD_S})
                else:
                    stop.ask("user")

    outcome = joint_loop(drive, WallClock(), guard, PERIOD_S).run(procedure(), ListSink(), stop)
    return *settled(running, drive, begun), outcome


def settled(running, drive, begun):
    """Wait for standstill; time to power-off [s], and way [rad]."""
    end_s, axis = time.perf_counter() + 3.0, running.device.axis
    while abs(axis.seen.velocity_rad_s) > 0.02 or axis.power.on:
        assert time.perf_counter() < end_s, (axis.seen, axis.power)
        time.sleep(0.005)
        drive.port.links[0].drain()
    return axis.power.since_s - begun[0], axis.seen.position_rad - begun[1]


@pytest.fixture(params=DRIVES)
def moving(request, tmp_path):
    """A drive, to be brought to speed."""
    sheet = DRIVES[request.param].write(tmp_path, request.param)
    with device(sheet) as running, host(running, rated_current_a=RATED_A) as drive:
        drive.open(PERIOD_S)
        yield request.param, running, drive


@pytest.mark.parametrize("cause", ["user", "limit"])
def test_a_stop_by_the_host_is_short(moving, cause) -> None:
    _, running, drive = moving
    off_s, way_rad, outcome = stopped(running, drive, cause)
    assert off_s < BRAKING_S - 0.1  # by the drive itself
    assert way_rad < COASTS_RAD
    assert "still braked" not in outcome.reason


def test_a_fault_of_the_drives_own_is_short(moving) -> None:
    name, running, drive = moving
    off_s, way_rad, outcome = stopped(running, drive, "fault")
    if name != "nothing-to-be-set":
        assert off_s < BRAKING_S
        assert way_rad < COASTS_RAD
        return
    assert off_s < RESET_S
    assert "state 'fault reaction active' did not end on power-off; the drive was reset (NMT)" in outcome.reason


def test_a_lost_host_is_short(moving) -> None:
    _, running, drive = moving
    drive.enable(Mode.CURRENT)
    cycles(drive, Command(Mode.CURRENT, 0.3), 0.5)
    axis = running.device.axis
    begun, speed_rad_s = (axis.time_s, axis.seen.position_rad), axis.seen.velocity_rad_s
    assert speed_rad_s > 0.5
    off_s, _ = settled(running, drive, begun)
    assert off_s < WATCHDOG_S + BRAKING_S


def notes_of(trait, folder, speed_rad_s=8.0):
    with device(trait.write(folder, "sheet")) as running, host(running) as drive:
        drive.highest_speed_rad_s = speed_rad_s
        drive.open(PERIOD_S)
        return " ".join(drive.describe().notes), running.device.dictionary.number(RAMP)


def test_a_ramp_is_made_as_steep_as_the_limit_of_speed_asks_for(tmp_path) -> None:
    for speed_rad_s in (2.0, 8.0):
        said, ramp = notes_of(DRIVES["slow-ramp"], tmp_path, speed_rad_s)
        assert ramp == pytest.approx(speed_rad_s / RAMP_S * 20.0 * 4096 / (2.0 * pi), abs=1.0)
        assert f"A stop from {speed_rad_s:g} rad/s takes 0.25 s on the drive's ramp (0x6085); then power-off." in said
    said, ramp = notes_of(Trait(), tmp_path)
    assert ramp == 1000 * 4096, "what is steep enough stays"
    assert "takes 0.025 s" in said


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("slow-ramp-without-unit", "is taken for that of velocity a second. In a fault, and"),
        ("slow-ramp-that-stays", "power off at once, for quick stop deceleration (0x6085:00) is 200, and can"),
        ("no-velocity-unit", "power off at once, for the unit of quick stop deceleration (0x6085:00) is told"),
        ("no-ramp-object", "A stop brakes as the drive does by itself"),
        ("nothing-to-be-set", "How long it brakes in a fault of its own is not known: fault reaction option code"),
    ],
)
def test_what_a_stop_does_is_told(name, says, tmp_path) -> None:
    said, _ = notes_of(DRIVES[name], tmp_path)
    assert says in said


@pytest.mark.parametrize(
    ("name", "sure"),
    [("slow-ramp", True), ("slow-ramp-without-unit", False), ("steep-without-unit", True), ("no-ramp-object", False)],
)
def test_where_no_host_watches_only_a_ramp_that_is_sure_is_used(name, sure, tmp_path) -> None:
    with device(DRIVES[name].write(tmp_path, name)) as running, host(running) as drive:
        drive.open(PERIOD_S)
        options = [running.device.dictionary.number(index) for index in (0x605A, 0x605E, LOST_HOST)]
    assert options == ([2, 2, 3] if sure else [2, 0, 2])
