"""The fault table: what goes wrong between driver and drive, and how it ends."""

import re
import time

import can
import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia402.bits import TorqueOffSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault, DriveStateError
from tests.drivers.canopen.conftest import JOINT

OFF = Command(Mode.OFF)
PUSH = Command(Mode.CURRENT, 0.2)
PATIENCE_S = 5.0  # of a test on a busy machine; the time limits themselves are far below


def _moving(drive):
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.exchange(PUSH)
    return drive


def _run(drive, command=PUSH, began_s=None):
    """Exchange until it raises; when each exchange began is noted where it is asked for."""
    deadline_s = time.perf_counter() + PATIENCE_S
    while time.perf_counter() < deadline_s:
        if began_s is not None:
            began_s.append(time.perf_counter())
        drive.exchange(command)
        time.sleep(0.002)
    pytest.fail("nothing was raised")


def _await_off(node):
    deadline_s = time.perf_counter() + PATIENCE_S
    while node.enabled:
        assert time.perf_counter() < deadline_s, "it is still on"
        time.sleep(0.001)


def _reconnects(drive):
    drive.close()
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    assert drive.exchange(PUSH).status is Status.ENABLED


def test_cable_out_ends_in_an_error_and_the_drives_own_stop(node, drive_of):
    drive = _moving(drive_of())
    node.silent = True
    with pytest.raises(DriveConnectionError, match=r"no answer to SYNC for .* s; at most 0.05 s is allowed"):
        _run(drive)
    with pytest.raises(DriveConnectionError, match="power-off is not confirmed"):
        drive.disable()
    _await_off(node)
    node.silent = False
    _reconnects(drive)


def test_a_host_that_falls_silent_is_stopped_for_within_the_watchdog(node, drive_of):
    drive = _moving(drive_of())
    start_s = time.perf_counter()
    _await_off(node)
    # the double looks at its clock every 2 ms; the last heartbeat may be a quarter of the watchdog old
    assert 0.07 < node.off_at_s - start_s < 0.1 + PATIENCE_S
    node._send(0x85, bytes(8))  # the drive hears the host again: no error any more
    with pytest.raises(DriveFault, match="0x8130, no heartbeat from the host in time"):
        _run(drive)
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert drive.exchange(PUSH).status is Status.ENABLED


def test_a_watchdog_that_takes_the_drive_out_of_operational_is_named(node, drive_of):
    node.absent.add((0x1029, 1))  # its value is 0: leave OPERATIONAL
    drive = _moving(drive_of())
    _await_off(node)
    with pytest.raises(DriveFault, match=r"left OPERATIONAL, it is PRE_OPERATIONAL: 0x8130"):
        _run(drive)
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert drive.exchange(PUSH).status is Status.ENABLED


def test_a_host_that_went_away_leaves_a_fault_that_its_successor_clears(node, drive_of):
    killed = _moving(drive_of())
    _await_off(node)
    successor = drive_of()
    successor.open(0.005)
    assert successor.exchange(OFF).status is Status.DISABLED
    killed.close()


def test_another_fault_is_not_cleared_by_connecting(node, drive_of):
    node.fail(0x2310)
    drive = drive_of()
    drive.open(0.005)
    assert drive.exchange(OFF).status is Status.FAULT
    with pytest.raises(DriveStateError, match="continuous over-current"):
        drive.enable(Mode.CURRENT)


def test_a_fault_during_motion_has_a_name_and_clears_to_off(node, drive_of):
    drive = _moving(drive_of())
    node.fail(0x8611)
    with pytest.raises(DriveFault, match="0x8611, following error"):
        _run(drive)
    with pytest.raises(DriveFault, match="following error"):
        drive.exchange(PUSH)
    assert drive.exchange(OFF).status is Status.FAULT
    drive.clear_fault()
    assert node.get(0x6041) & 0x6F == 0x40, "it stops at SWITCH ON DISABLED"
    assert drive.exchange(OFF).status is Status.DISABLED
    drive.enable(Mode.CURRENT)


def test_a_fault_without_emcy_is_read_from_the_drive(node, drive_of):
    drive = _moving(drive_of())
    node.put(0x603F, 0, 0x3210)
    node.put(0x6041, 0, 0x0208)
    with pytest.raises(DriveFault, match="0x3210, over-voltage"):
        _run(drive)


def test_a_fault_that_stays_cannot_be_cleared(node, drive_of):
    drive = _moving(drive_of(fault_reset_s=0.3))
    node.fail(0x4310)
    node._become = lambda _word: None
    with pytest.raises(DriveFault):
        _run(drive)
    with pytest.raises(DriveFault, match=r"cannot be cleared: 0x4310, drive temperature too high, after 0\.3 s;"):
        drive.clear_fault()


def test_a_stage_that_is_taken_away_without_a_fault_is_noticed(node, drive_of):
    drive = _moving(drive_of())
    node._control = lambda: None
    node.put(0x6041, 0, 0x0240)
    with pytest.raises(DriveFault, match=r"switched itself off: state 'switch on disabled'.*safe torque off"):
        _run(drive)


def test_a_drive_that_does_not_switch_on_says_where_it_stays(node, drive_of):
    drive = drive_of(enable_s=0.3)
    drive.open(0.005)
    node._control = lambda: None
    with pytest.raises(DriveStateError, match=r"state is 'switch on disabled' 0\.3 s after enabling began"):
        drive.enable(Mode.CURRENT)
    assert node.get(0x1016, 1) == 0


@pytest.mark.parametrize("read_only", [False, True])
def test_a_mode_that_is_refused_leaves_the_power_off(node, drive_of, read_only):
    drive = drive_of()
    drive.open(0.005)
    node.refuse_mode = True
    if read_only:
        node.read_only.add((0x6060, 0))
    with pytest.raises(DriveConfigurationError, match=r"mode 10 is refused: .*; 10 is wanted"):
        drive.enable(Mode.CURRENT)
    assert not node.enabled
    with pytest.raises(DriveStateError):
        drive.exchange(PUSH)


def test_a_mode_that_the_drive_does_not_list_is_not_tried(node, drive_of):
    node.put(0x6502, 0, 1 << 7)
    drive = drive_of()
    drive.open(0.005)
    assert drive.describe().modes == {Mode.POSITION}
    with pytest.raises(DriveConfigurationError, match="has no mode 'current', only position"):
        drive.enable(Mode.CURRENT)


PATIENT = {"watchdog_s": 2.0, "answer_s": 1.5}  # a busy machine makes answers late by itself


def _fresh(drive):
    """A sample of the SYNC that was sent last."""
    deadline_s = time.perf_counter() + PATIENCE_S
    while time.perf_counter() < deadline_s:
        sample = drive.exchange(PUSH)
        if sample.number == drive.counts.sent:
            return sample
    pytest.fail("no answer in time")


def test_a_lost_answer_gives_the_old_sample_with_its_age_and_is_counted(node, drive_of):
    drive = _moving(drive_of(**PATIENT))
    before, missed = _fresh(drive), drive.counts.missed
    node.drop_answers = 1
    stale = drive.exchange(PUSH)
    assert stale.number == before.number
    assert stale.time_s == before.time_s
    assert stale.age_s > 0.01, "it waited"
    assert _fresh(drive).number >= before.number + 2
    assert drive.counts.missed > missed


def test_lost_answers_are_known_to_be_lost_when_the_next_object_is_told(node, drive_of):
    drive = _moving(drive_of(**PATIENT))
    node.drop_answers = 10
    ages_s = []
    deadline_s = time.perf_counter() + 1.0
    while time.perf_counter() < deadline_s:
        ages_s.append(drive.exchange(PUSH).age_s)
        time.sleep(0.003)
    assert max(ages_s) > 0.1, "ten waits in vain"
    assert min(ages_s[-50:]) < 0.01  # and not ten periods, as if answers were still under way


def test_an_answer_that_comes_late_is_not_taken_for_the_next_one(node, drive_of):
    drive = _moving(drive_of(**PATIENT))
    before, late = _fresh(drive), drive.counts.late
    node.delay_s = 0.014  # the cycle waits 10 ms; a busy machine may wait for two answers
    found = [drive.exchange(PUSH) for _ in range(10)]
    assert found[-1].number > before.number
    assert min(sample.age_s for sample in found) > 0.01, "each is as old as its own SYNC"
    assert drive.counts.late > late


def test_feedback_that_stays_stale_is_an_error(node, drive_of):
    drive = _moving(drive_of())
    node.drop_answers = 10**6
    with pytest.raises(DriveConnectionError, match="no answer to SYNC"):
        _run(drive)


def test_frames_that_are_not_what_they_should_be_are_counted_and_not_believed(node, drive_of):
    drive = _moving(drive_of(**PATIENT))
    before = _fresh(drive)
    node.drop_answers = 1
    node._send(0x185, b"\x37\x02")  # too short
    node._send(0x285, bytes(7))
    node._send(0x85, b"\x10")
    node._send(0x705, b"\x33")
    node._send(0x1FF, bytes(8))  # nobody's
    stale = drive.exchange(PUSH)
    assert stale.number == before.number
    assert _fresh(drive).number >= before.number + 2
    assert drive.garbled == 4


def test_a_bus_that_goes_off_in_motion_ends_in_the_drives_own_stop(node, channel, monkeypatch):
    """The kernel's error frame of a controller that has left the bus, on a bus inside this process."""
    monkeypatch.setattr(
        "drivers.canopen.cia301.link.open_bus", lambda _settings, _device: can.Bus(interface="virtual", channel=channel)
    )
    drive = _moving(
        CanopenDrive(CanopenSettings(bus=BusSettings("socketcan", channel), node_id=5, host_node_id=127), JOINT)
    )
    try:
        node.bus.send(can.Message(arbitration_id=0x40, is_error_frame=True, data=bytes(8)))
        node.silent = True  # nothing passes a controller that is off the bus
        start_s = time.perf_counter()
        with pytest.raises(DriveConnectionError, match=r"the bus is off after too many errors; check wiring"):
            _run(drive)
        with pytest.raises(DriveConnectionError, match="power-off is not confirmed"):
            drive.disable()
        assert time.perf_counter() - start_s < drive.describe().longest_call_s
        _await_off(node)
        node.silent = False
        _reconnects(drive)
    finally:
        drive.close()


def test_a_drive_that_restarts_in_motion_is_noticed(node, drive_of):
    drive = _moving(drive_of())
    node.restart()
    with pytest.raises(DriveConnectionError, match="has restarted"):
        _run(drive)
    _reconnects(drive)


def test_a_drive_that_was_switched_on_just_now_may_be_opened(node, drive_of):
    drive = drive_of()
    answer = node._answer

    def first_boots(data):
        node._answer = answer
        node.restart()
        answer(data)

    node._answer = first_boots
    drive.open(0.005)
    assert drive.exchange(OFF).status is Status.DISABLED


def test_a_heartbeat_that_stays_away_is_an_error(node, drive_of):
    drive = _moving(drive_of())
    node.mute_heartbeat = True
    began_s = []
    with pytest.raises(DriveConnectionError, match=r"no heartbeat for 0\.\d+ s") as raised:
        _run(drive, began_s=began_s)
    said_s = float(re.search(r"for (\S+) s", str(raised.value))[1])
    # after three heartbeats of 50 ms. Each exchange looks once, so no two looks are further apart than the begin of one
    # from the end of the next, however long the machine let them wait
    apart_s = time.perf_counter() - began_s[-2]
    assert 0.15 <= said_s < 0.15 + apart_s + 0.001  # three digits are said


@pytest.mark.parametrize(
    ("key", "value", "changes", "match"),
    [
        ((0x1000, 0), 0x00020191, {}, "device profile is 401; 402, a drive, is wanted"),
        ((0x1018, 4), 0xBEEF, {"serial_number": 0xCAFE}, "serial_number is 0xBEEF; 0xCAFE is wanted"),
        ((0x1018, 1), 0x12345, {"profile": "epos4"}, "vendor ID is 0x12345; profile 'epos4' is for 0xFB"),
        ((0x60A9, 0), 0xFFB44700, {"velocity_unit": "rpm"}, "which is 0.1 rpm .*; the settings say rpm"),
    ],
)
def test_the_wrong_drive_or_unit_is_refused_before_anything_is_written(node, drive_of, key, value, changes, match):
    node.put(*key, value)
    with pytest.raises(DriveConfigurationError, match=match):
        drive_of(**changes).open(0.005)
    assert node.get(0x6007) == 1


def test_another_encoder_than_configured_is_refused(node, drive_of):
    node.objects |= {(0x608F, 1): ["<I", 2000], (0x608F, 2): ["<I", 1]}
    with pytest.raises(DriveConfigurationError, match=r"counts per motor turn are 2000 .* the rig says 4096"):
        drive_of().open(0.005)


def test_nobody_at_the_node_id_is_said_in_bounded_time(node, drive_of):
    start_s = time.perf_counter()
    with pytest.raises(DriveConnectionError, match="is the drive on, the cable in, node ID and bit rate right"):
        drive_of(node_id=6).open(0.005)
    assert time.perf_counter() - start_s < PATIENCE_S


def test_answers_to_a_host_that_was_here_before_are_let_go(node, drive_of):
    drive = drive_of()
    answer = node._answer

    def late(data):
        """What two requests of the host before got, come in together with the first answer to this one."""
        node._answer = answer
        node._send(0x585, bytes.fromhex("60 40 60 00 00 00 00 00"))
        node._send(0x585, bytes.fromhex("43 18 10 04 ef be 00 00"))
        node._send(0x585, bytes.fromhex("80 71 60 00 00 00 02 06"))
        answer(data)

    node._answer = late
    drive.open(0.005)
    assert drive.exchange(OFF).status is Status.DISABLED


def test_a_host_that_is_held_up_finds_the_answer_that_has_come_meanwhile(node, drive_of):
    drive = _moving(drive_of(**PATIENT))
    receive = drive._link.receive

    def held_up(timeout_s):
        drive._link.receive = receive
        time.sleep(0.1)  # longer than a cycle waits
        return False

    before, missed = _fresh(drive), drive.counts.missed
    drive._link.receive = held_up
    assert drive.exchange(PUSH).number == before.number + 1
    assert drive.counts.missed == missed


def test_a_drive_that_does_not_answer_sync_is_not_opened(node, drive_of):
    node.drop_answers = 10**6
    with pytest.raises(DriveConnectionError, match=r"none of \d+ SYNC frames was answered"):
        drive_of().open(0.005)


def test_a_host_that_is_held_up_again_and_again_is_no_silence_of_the_drive(node, drive_of):
    drive = _moving(drive_of(watchdog_s=5.0, answer_s=0.05))
    receive, cycle = drive._link.receive, drive._session.cycle

    def held_up(_timeout_s):
        time.sleep(0.06)  # longer than the drive may be silent
        return False

    node.drop_answers = 1
    drive._link.receive = held_up
    drive.exchange(PUSH)
    assert cycle.silence_s < 0.05, "it has listened for one wait of 10 ms, however long that took"
    drive._link.receive = receive
    assert drive.exchange(PUSH).status is Status.ENABLED


STO = TorqueOffSettings(index=0x60FD, bit=3)


def test_safe_torque_off_is_no_fault_and_is_seen_before_the_power_comes(node, drive_of):
    node.objects[0x60FD, 0] = ["<I", 1 << 3]
    drive = drive_of(torque_off=STO)
    drive.open(0.005)
    found = drive.inspect()
    assert (found.status, found.fault) == (Status.DISABLED, "")
    assert found.torque_off == "bit 3 of 0x60FD:00 is 1"
    node.received.clear()
    with pytest.raises(DriveStateError, match="safe torque off is active"):
        drive.enable(Mode.CURRENT)
    assert not any(cob == 0x205 and data[0] == 0x0F for cob, data in node.received), "it was told to switch on"
    node.put(0x60FD, 0, 1 << 4)  # others do not matter
    assert drive.inspect().torque_off == ""
    drive.enable(Mode.CURRENT)
    assert node.enabled


def test_the_level_of_its_bit_may_be_the_other_one_in_an_object_of_a_byte(node, drive_of):
    node.objects[0x3240, 4] = ["<B", 3]
    drive = drive_of(torque_off=TorqueOffSettings(index=0x3240, subindex=4, bit=0, level=0))
    drive.open(0.005)
    assert drive.inspect().torque_off == ""
    node.put(0x3240, 4, 2)
    assert drive.inspect().torque_off == "bit 0 of 0x3240:04 is 0"


def test_a_bit_that_the_drive_does_not_tell_is_refused_when_it_is_opened(node, drive_of):
    with pytest.raises(DriveConfigurationError, match=r"0x60FD:00.*refused"):
        drive_of(torque_off=STO).open(0.005)
    assert not node.enabled
