"""Two joints of one bench on one bus: one SYNC in each cycle, each drive guarded, each seen at the same moment."""

import time
from contextlib import ExitStack

import can
import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.one_bus import share_buses
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError
from drivers.joint import JointScale
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

pytestmark = pytest.mark.virtual_time  # a drive that the host asks late in a period has a SYNC of its own, rightly

NODES, PERIOD_S, WATCHDOG_S = (5, 6), 0.02, 0.4
OFF, PUSH, REST = Command(Mode.OFF), Command(Mode.CURRENT, 0.3), Command(Mode.CURRENT, 0.0)


def joint_at(node: int, channel: str, **settings) -> CanopenDrive:
    usual = {"watchdog_s": WATCHDOG_S, "answer_s": 0.3, "listen_s": 0.05} | settings
    return CanopenDrive(
        CanopenSettings(bus=BusSettings("virtual", channel), node_id=node, **usual), JointScale(4096, 20.0)
    )


@pytest.fixture
def pair(request):
    """Two simulated drives on a bus, their drivers sharing it, and a third party that hears everything."""
    channel = request.node.name
    with ExitStack() as stack:
        devices = [
            stack.enter_context(serve_canopen(CanOpenSettings(interface="virtual", channel=channel, node_id=node)))
            for node in NODES
        ]
        drives = [joint_at(node, channel) for node in NODES]
        share_buses(drives)
        listener = stack.enter_context(can.Bus(interface="virtual", channel=channel, ignore_config=True))
        for drive in drives:
            stack.callback(drive.close)
            drive.open(PERIOD_S)
        yield drives, [one.device for one in devices], listener


def heard(listener) -> list[int]:
    """COB-IDs since the last time."""
    ids = []
    while (message := listener.recv(0.0)) is not None:
        ids.append(message.arbitration_id)
    return ids


def cycles(drives, commands, count: int):
    """As the control loop does it: one exchange with each drive, every period."""
    samples = []
    for _ in range(count):
        time.sleep(PERIOD_S)
        samples.append([drive.exchange(command) for drive, command in zip(drives, commands, strict=True)])
    return samples


def test_one_sync_in_each_cycle_for_both(pair) -> None:
    drives, _, listener = pair
    cycles(drives, (OFF, OFF), 3)
    heard(listener)
    cycles(drives, (OFF, OFF), 25)
    ids = heard(listener)
    assert ids.count(0x80) == 25
    assert ids.count(0x185) == ids.count(0x186) == 25
    assert [drive.counts.missed + drive.counts.surplus for drive in drives] == [0, 0]


def test_both_are_seen_at_one_moment(pair) -> None:
    drives, _, _ = pair
    for first, second in cycles(drives, (OFF, OFF), 10)[2:]:
        assert first.time_s == second.time_s


def test_both_move_and_each_by_its_own_demand(pair) -> None:
    drives, devices, _ = pair
    starts = [drive.exchange(OFF).position_rad for drive in drives]
    for drive in drives:
        drive.enable(Mode.CURRENT)
    last = cycles(drives, (PUSH, REST), 20)[-1]
    moved = [sample.position_rad - start for sample, start in zip(last, starts, strict=True)]
    assert moved[0] > 0.05
    assert abs(moved[1]) < 0.01
    assert {sample.status for sample in last} == {Status.ENABLED}
    drives[0].disable()
    assert [device.axis.power.on for device in devices] == [False, True]
    assert cycles(drives, (OFF, REST), 5)[-1][1].status is Status.ENABLED


def test_a_joint_that_is_not_asked_any_more_stops_though_the_other_goes_on(pair) -> None:
    drives, devices, _ = pair
    for drive in drives:
        drive.enable(Mode.CURRENT)
    cycles(drives, (PUSH, REST), 5)
    cycles(drives[1:], (REST,), round(2.0 * WATCHDOG_S / PERIOD_S))
    assert [device.axis.power.on for device in devices] == [False, True]


def test_both_stop_when_the_host_is_silent(pair) -> None:
    drives, devices, listener = pair
    for drive in drives:
        drive.enable(Mode.CURRENT)
    cycles(drives, (PUSH, PUSH), 5)
    time.sleep(2.0 * WATCHDOG_S)
    heard(listener)
    assert [device.axis.power.on for device in devices] == [False, False]


def test_the_one_goes_on_when_the_other_is_closed_and_opened_again(pair) -> None:
    drives, _, _ = pair
    drives[0].close()
    assert cycles(drives[1:], (OFF,), 5)[-1][0].age_s < PERIOD_S
    drives[0].open(PERIOD_S)
    seen = cycles(drives, (OFF, OFF), 50)  # a busy machine may take a quarter of a second for the first answers
    assert all(first.time_s == second.time_s for first, second in seen[-5:])


def test_a_host_that_is_no_joint_of_the_bench_is_named_all_the_same(pair) -> None:
    drives, _, listener = pair
    listener.send(can.Message(arbitration_id=0x80, is_extended_id=False))
    with pytest.raises(DriveConnectionError, match="another host is on the bus: it sends SYNC"):
        cycles(drives, (OFF, OFF), 2)


def test_one_drive_for_two_joints_is_refused() -> None:
    with pytest.raises(DriveConfigurationError, match="is the drive of two joints of this bench"):
        share_buses([joint_at(5, "x"), joint_at(5, "x")])


def test_two_bit_rates_on_one_bus_are_refused() -> None:
    slow = CanopenDrive(
        CanopenSettings(bus=BusSettings("virtual", "x", bitrate=500_000), node_id=6), JointScale(4096, 20)
    )
    with pytest.raises(DriveConfigurationError, match="their settings of it differ"):
        share_buses([joint_at(5, "x"), slow])


def test_drives_on_two_buses_keep_their_own() -> None:
    drives = [joint_at(5, "x"), joint_at(5, "y")]
    share_buses(drives)
    assert drives[0].port is not drives[1].port
