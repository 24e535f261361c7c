"""Bytes of CiA 301 and CiA 402, written out by hand."""

import pytest

from drivers.canopen.cia301.emergency import Emergency
from drivers.canopen.cia301.error_codes import error_codes
from drivers.canopen.cia301.heartbeat import DriveMonitor, NmtState
from drivers.canopen.cia301.objects import (
    CONTROLWORD,
    POSITION,
    STATUSWORD,
    TARGET_POSITION,
    TARGET_TORQUE,
    TORQUE_OFFSET,
    VELOCITY,
    DataType,
    DriveObject,
)
from drivers.canopen.cia301.pdo import Pdo, PdoLayout, same
from drivers.canopen.cia402.profiles import CIA402, EPOS4
from drivers.canopen.slow_poll import SlowPoll


def test_a_torque_command_and_its_controlword_are_one_frame():
    layout = PdoLayout([CONTROLWORD, TARGET_TORQUE])
    assert layout.pack(0x0F, -200).hex() == "0f0038ff"


def test_a_position_command_with_torque_offset_fills_a_frame():
    layout = PdoLayout([CONTROLWORD, TARGET_POSITION, TORQUE_OFFSET])
    assert layout.pack(0x3F, -70000, 25).hex() == "3f0090eefeff1900"


def test_a_tpdo_of_an_epos4():
    layout = PdoLayout([STATUSWORD, EPOS4.current, EPOS4.duty])
    assert layout.unpack(bytes.fromhex("37120cfefffff401")) == (0x1237, -500, 500)


def test_a_tpdo_of_position_and_velocity():
    assert PdoLayout([POSITION, VELOCITY]).unpack(bytes.fromhex("00f0ffff4b000000")) == (-4096, 75)


def test_nine_bytes_do_not_fit():
    with pytest.raises(ValueError, match="9 bytes"):
        PdoLayout([POSITION, VELOCITY, DriveObject(0x6061, 0, DataType.I8, "mode")])


def test_a_mapping_is_off_while_it_changes():
    pdo = Pdo(1, True, 0x185, PdoLayout([STATUSWORD, EPOS4.current, EPOS4.duty]))
    assert [(write.object.index, write.object.subindex, write.value) for write in pdo.writes()] == [
        (0x1800, 1, 0xC0000185),
        (0x1800, 2, 1),
        (0x1A00, 0, 0),
        (0x1A00, 1, 0x60410010),
        (0x1A00, 2, 0x30D10220),
        (0x1A00, 3, 0x32030110),
        (0x1A00, 0, 3),
        (0x1800, 1, 0x40000185),
    ]


def test_a_second_rpdo_has_its_own_records():
    pdo = Pdo(2, False, 0x305, PdoLayout([CONTROLWORD, TARGET_POSITION]))
    assert {(item.index, item.subindex): value for item, value in pdo.expected()} == {
        (0x1401, 1): 0x305,
        (0x1401, 2): 1,
        (0x1601, 0): 2,
        (0x1601, 1): 0x60400010,
        (0x1601, 2): 0x607A0020,
    }


def test_only_bit_30_of_a_cob_id_may_read_back_otherwise():
    cob_id, count = (
        Pdo(1, True, 0x185, PdoLayout([STATUSWORD])).writes()[0].object,
        DriveObject(0x1A00, 0, DataType.U8, ""),
    )
    assert same(cob_id, 0x00000185, 0x40000185)
    assert not same(cob_id, 0x80000185, 0x40000185)
    assert not same(cob_id, 0x00000186, 0x40000185)
    assert not same(count, 2, 3)


def test_an_emergency_names_the_error():
    emergency = Emergency.decode(bytes.fromhex("1186210102030405"))
    assert (emergency.code, emergency.register, emergency.details) == (0x8611, 0x21, bytes([1, 2, 3, 4, 5]))
    assert error_codes().name(emergency.code) == "0x8611, following error"


@pytest.mark.parametrize(
    ("code", "name"),
    [
        (0x2310, "0x2310, continuous over-current"),
        (0x3210, "0x3210, over-voltage of the DC link"),
        (0x3220, "0x3220, under-voltage of the DC link"),
        (0x4210, "0x4210, device temperature too high"),
        (0x8130, "0x8130, no heartbeat from the host in time"),
        (0x2371, "0x2371, current"),
        (0xFF01, "0xFF01, manufacturer specific: see the manual of the drive"),
        (0xA000, "0xA000, not in CiA 301 or 402"),
    ],
)
def test_error_codes_have_names_or_a_class(code, name):
    assert error_codes().name(code) == name


def test_a_vendors_table_comes_before_the_standards():
    maxon, other = error_codes(0xFB), error_codes(0x1A3)
    assert maxon.name(0x81FD) == "0x81FD, CAN bus turned off"
    assert maxon.name(0x8613) == other.name(0x8613) == "0x8613, homing"
    assert other.name(0x81FD) == "0x81FD, monitoring"


def test_an_emergency_of_another_length_is_none():
    with pytest.raises(ValueError, match="8 bytes"):
        Emergency.decode(b"\x10\x23\x01")


def test_a_poll_is_an_sdo_upload_and_takes_its_own_answer_only():
    poll = SlowPoll((CIA402.supply,), interval_s=0.25)
    assert poll.request(1.0).hex() == "4079600000000000"
    assert poll.request(1.1) is None
    assert not poll.take(bytes.fromhex("4b41600037020000"), 1.1), "an answer to somebody else"
    assert poll.take(bytes.fromhex("43796000f25d0000"), 1.2)
    assert poll.readings[CIA402.supply] == (24050, 1.2)
    assert poll.request(1.24) is None
    assert poll.request(1.26) is not None


def test_a_poll_that_is_refused_or_lost_keeps_the_old_value_and_goes_on():
    poll = SlowPoll((CIA402.supply, EPOS4.temperature), interval_s=0.2)
    poll.put(CIA402.supply, 24000, 0.5)
    assert poll.request(1.0).hex() == "4079600000000000"
    assert poll.take(bytes.fromhex("8079600000000206"), 1.01)
    assert poll.request(1.11).hex() == "4001320100000000"
    assert poll.request(1.22) is None, "still under way"
    assert poll.request(1.32) is not None, "given up"
    assert poll.readings == {CIA402.supply: (24000, 0.5)}


def test_heartbeats_are_told_and_missed():
    monitor = DriveMonitor(timeout_s=0.15)
    monitor.hear(b"\x05", 10.0)
    assert monitor.state is NmtState.OPERATIONAL
    assert monitor.silence_s(10.0) == 0.0
    assert monitor.silence_s(10.1) == pytest.approx(0.1)
    assert monitor.silence_s(10.2) == pytest.approx(0.2)
    assert monitor.silence_s(60.0) == 0.0, "nobody listened: it starts anew"
    assert not monitor.restarted
    monitor.hear(b"\x00", 60.1)
    monitor.hear(b"\x7f", 60.2)
    assert monitor.restarted
    assert monitor.state is NmtState.PRE_OPERATIONAL
    for nonsense in (b"", b"\x05\x05", b"\x33"):
        with pytest.raises(ValueError, match=r"heartbeat|NmtState"):
            monitor.hear(nonsense, 60.3)
