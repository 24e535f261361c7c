"""The driver and the simulated drive: two readings of the standard, one conversation.

It is behind an slcan adapter, in virtual time. Over the network, on a port of the operating system, and where its host
is killed, it is in `tests.drivers.conformance`.
"""

import time
from contextlib import suppress

import pytest

from drivers.canopen.cia402.bits import BrakeBit, TorqueOffSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, DriveFault, DriveStateError
from tests.devices.device_process import Thread
from tests.drivers.canopen.conversation import (
    JOINT,
    WATCHDOG_S,
    bus_of,
    driver_of,
    exchange_for,
    hold,
    started,
)

OFF = Command(Mode.OFF)
PUSH = Command(Mode.CURRENT, 0.25)
QUICK_STOP_S = 0.5  # the simulated drive brakes on its ramp before the power goes
BUSY_S = 1.0  # what a busy machine may add
pytestmark = pytest.mark.virtual_time


@pytest.fixture(scope="module")
def slcan_device(tmp_path_factory):
    # a name that stays when the port goes and comes back, as udev gives it to an adapter
    with started("slcan", "--link", str(tmp_path_factory.mktemp("adapter") / "can")) as device:
        yield device


@pytest.fixture
def slcan(slcan_device):
    with driver_of(slcan_device) as drive:
        yield slcan_device, drive


def _raises(drive, error=DriveError, command=PUSH, timeout_s=5.0):
    """Exchange until it raises; the error, and how long that took [s]."""
    start_s = time.perf_counter()
    with pytest.raises(error) as caught:
        exchange_for(drive, timeout_s, command)
    return caught.value, time.perf_counter() - start_s


def _moving(drive):
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    exchange_for(drive, 0.1, PUSH)
    return drive


def _reconnects(drive):
    drive.close()
    drive.open(0.005)
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert exchange_for(drive, 0.05, PUSH)[-1].status is Status.ENABLED
    drive.disable()


def test_the_host_closes_the_position(slcan):
    device, drive = slcan
    drive.open(0.005)
    target_rad = drive.exchange(OFF).position_rad + 0.3
    drive.enable(Mode.CURRENT)
    sample = hold(drive, target_rad, 2.5)
    assert sample.position_rad == pytest.approx(target_rad, abs=0.1)
    drive.quick_stop()
    exchange_for(drive, 0.3, OFF)
    drive.disable()
    device.wait_for_power(on=False)


@pytest.mark.parametrize("position_mode", ["cyclic", "profile"])
def test_the_drive_closes_the_position(slcan_device, position_mode):
    with driver_of(slcan_device, position_mode=position_mode) as drive:
        drive.open(0.005)
        start_rad = drive.exchange(OFF).position_rad
        drive.enable(Mode.POSITION)
        for step in range(100):
            exchange_for(drive, 0.01, Command(Mode.POSITION, start_rad + 0.3 * step / 100))
        sample = exchange_for(drive, 1.0, Command(Mode.POSITION, start_rad + 0.3))[-1]
        assert sample.position_rad == pytest.approx(start_rad + 0.3, abs=0.02)


def test_a_feed_forward_current_is_added_to_the_drives_own(slcan):
    _, drive = slcan
    drive.open(0.005)
    here_rad = drive.exchange(OFF).position_rad
    drive.enable(Mode.POSITION)
    before_a = exchange_for(drive, 0.3, Command(Mode.POSITION, here_rad))[-1].current_a
    after = exchange_for(drive, 0.1, Command(Mode.POSITION, here_rad, feed_forward_a=0.1))
    # at once; then the drive's position loop takes it back
    assert max(one.current_a for one in after) - before_a == pytest.approx(0.1, abs=0.05)


def test_what_is_measured_agrees_with_itself(slcan):
    _, drive = slcan
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    samples = exchange_for(drive, 0.4, PUSH)
    fresh = {sample.number: sample for sample in samples}
    first, last = fresh[min(fresh)], fresh[max(fresh)]
    mean_rad_s = (last.position_rad - first.position_rad) / (last.time_s - first.time_s)
    assert min(s.velocity_rad_s for s in samples) < mean_rad_s < max(s.velocity_rad_s for s in samples)
    assert last.velocity_rad_s > 0.5
    assert last.current_a == pytest.approx(0.25, abs=0.02)
    assert last.supply_v == pytest.approx(24.0, abs=0.5)
    assert drive.counts.missed == drive.counts.surplus == 0


def test_an_epos4_is_found_and_its_duty_told():
    with started("slcan", "--family", "epos4") as device, driver_of(device, duty_sign_from_current=True) as drive:
        drive.open(0.005)
        told = drive.describe()
        assert told.vendor == "maxon"
        assert {"duty", "temperature_c", "supply_v", "current_a"} <= told.measured
        drive.enable(Mode.CURRENT)
        samples = exchange_for(drive, 0.3, PUSH)
        # eq. (3) of the paper: duty x supply = R i + Ke x motor speed, R 8 ohm and Ke 0.05 V s/rad on this joint
        expected = (8.0 * samples[-1].current_a + 0.05 * 20.0 * samples[-1].velocity_rad_s) / samples[-1].supply_v
        assert samples[-1].duty == pytest.approx(expected, abs=0.03)


def test_cable_out_in_motion_ends_in_power_off_and_reconnects(slcan):
    device, drive = slcan
    _moving(drive)
    cut_s = time.monotonic()
    device.side.ask("link", name="silent")
    error, took_s = _raises(drive, DriveConnectionError)
    assert "no answer to SYNC" in str(error)
    assert took_s < drive.describe().longest_call_s
    with pytest.raises(DriveConnectionError, match="power-off is not confirmed"):
        drive.disable()
    # the host's last heartbeat may have left up to one call after the cut, but did not arrive
    assert device.wait_for_power(on=False) - cut_s < WATCHDOG_S + QUICK_STOP_S + BUSY_S
    device.side.ask("repair")
    _reconnects(drive)


def test_a_port_that_goes_and_comes_back(slcan):
    device, drive = slcan
    _moving(drive)
    gone_s = time.monotonic()
    device.side.ask("link", name="disconnect", duration_s=1.0)
    error, _ = _raises(drive, DriveConnectionError)
    assert "open" in str(error)
    assert device.wait_for_power(on=False) - gone_s < WATCHDOG_S + QUICK_STOP_S + BUSY_S
    drive.close()
    for _ in range(50):
        try:
            drive.open(0.005)
            break
        except DriveConnectionError:
            time.sleep(0.1)
    _reconnects(drive)


def test_corrupted_frames_end_in_power_off_or_do_no_harm(slcan):
    device, drive = slcan
    _moving(drive)
    device.side.ask("link", name="corrupt", probability=0.2)
    error = None
    try:
        exchange_for(drive, 2.0, PUSH)
    except DriveError as raised:
        error = raised
    with suppress(DriveError):
        drive.disable()
    device.wait_for_power(on=False)
    assert error is not None or drive.garbled > 0
    device.side.ask("repair")
    _reconnects(drive)


def drop_soon(device):
    time.sleep(0.1)
    device.side.ask("link", name="drop", packets=8, direction="from-device")


def test_lost_frames_are_counted_and_only_cost_their_cycle(slcan):
    device, drive = slcan
    _moving(drive)
    # asked for while cycles run: in a pause the device sends heartbeats alone, and those would be what is lost
    asking = Thread(target=drop_soon, args=(device,))
    asking.start()
    samples = exchange_for(drive, 1.0, Command(Mode.CURRENT, 0.0))
    asking.join()
    assert drive.counts.missed >= 1
    assert max(sample.age_s for sample in samples) > 0.01
    assert samples[-1].number >= drive.counts.sent - 1


def test_a_fault_of_the_drive_has_its_name(slcan):
    device, drive = slcan
    _moving(drive)
    device.side.ask("fault", name="over-current", duration_s=0.3)
    error, _ = _raises(drive, DriveFault)
    assert "over-current" in str(error)
    device.wait_for_power(on=False)
    time.sleep(0.4)
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    drive.disable()


def test_torque_that_is_taken_away_is_noticed(slcan):
    device, drive = slcan
    _moving(drive)
    device.side.ask("fault", name="torque-disabled", duration_s=0.5)
    error, _ = _raises(drive, DriveFault)
    assert "switched itself off" in str(error)
    device.wait_for_power(on=False)


def test_the_interlock_bit_tells_safe_torque_off_until_its_circuit_is_closed(slcan_device):
    with driver_of(slcan_device, torque_off=TorqueOffSettings(index=0x60FD, bit=3)) as drive:
        drive.open(0.005)
        assert drive.inspect().torque_off == ""
        slcan_device.side.ask("fault", name="torque-disabled")
        found = drive.inspect()
        assert (found.fault, found.torque_off) == ("", "bit 3 of 0x60FD:00 is 1")
        with pytest.raises(DriveStateError, match="safe torque off is active"):
            drive.enable(Mode.CURRENT)
        slcan_device.side.ask("repair")
        drive.enable(Mode.CURRENT)
        drive.disable()


@pytest.fixture(scope="module", params=[(), ("--sets-brake",)], ids=["by an output", "by the drive"])
def braked(request, tmp_path_factory):
    plant = tmp_path_factory.mktemp("plant") / "plant.toml"
    plant.write_text("[brake]\ntorque_n_m = 0.2\nrelease_s = 0.05\nengage_s = 0.1\n")
    with started("slcan", "--plant", str(plant), *request.param) as device:
        yield device, bool(request.param)


def test_a_holding_brake_is_set_without_power_and_holds_when_the_host_is_gone(braked):
    device, is_own = braked
    with driver_of(device, brake=None if is_own else BrakeBit()) as drive:
        drive.open(0.005)
        drive.enable(Mode.CURRENT)
        if not is_own:  # powered and pushed, and still held
            assert exchange_for(drive, 0.3, PUSH)[-1].position_rad == pytest.approx(0.0, abs=0.02)
            drive.set_brake(released=True)
        exchange_for(drive, 0.5, PUSH)
        time.sleep(2.0 * WATCHDOG_S)  # nobody is there any more
        device.wait_for_power(on=False)
    time.sleep(0.5)
    assert device.truth()["joint"]["arm_rad_s"] == pytest.approx(0.0, abs=0.05)
    assert device.truth()["device"]["brake"] == "set"


def test_a_drive_with_a_brake_of_its_own_holds_the_arm_until_the_brake_does(braked):
    device, is_own = braked
    if not is_own:
        pytest.skip("the host sets it")
    device.side.hang_load(0.25, False)
    device.side.ask("hold", angle_rad=1.0)
    with driver_of(device) as drive:
        drive.open(0.005)
        device.side.ask("release")
        here_rad = drive.exchange(OFF).position_rad
        drive.enable(Mode.POSITION)
        exchange_for(drive, 0.5, Command(Mode.POSITION, here_rad))
        drive.stand_down(0.1)
        device.wait_for_power(on=False)
        assert exchange_for(drive, 0.5, OFF)[-1].position_rad == pytest.approx(here_rad, abs=0.03)


def test_another_unit_than_configured_is_refused_before_motion(slcan):
    device, _ = slcan
    with (
        driver_of(device, velocity_unit="0.1 rpm") as other,
        pytest.raises(DriveConfigurationError, match=r"the settings say 0\.1 rpm"),
    ):
        other.open(0.005)


def test_nobody_at_the_node_id(slcan):
    device, _ = slcan
    with pytest.raises(DriveConnectionError, match="node ID"):
        CanopenDrive(CanopenSettings(bus=bus_of(device), node_id=6), JOINT).open(0.005)
