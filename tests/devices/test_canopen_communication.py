"""CiA 301, byte for byte: SDO, NMT, PDO, heartbeats, emergencies."""

import canopen
import pytest

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.objects.epos4 import EPOS4
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.canopen.serve import eds_text
from sim_backend.faults.script import OverCurrent
from tests.devices.can_host import NODE, CanHost

PRE_OPERATIONAL, OPERATIONAL = b"\x7f", b"\x05"
MASTER = 0x7F


def _operational(host: CanHost) -> CanHost:
    host.send(0x000, "01 05")
    return host


def _map(host: CanHost, link: int, mapping: int, can_id: int, kind: int, *entries: int) -> None:
    """The order that CiA 301 wants."""
    assert host.write(link, 1, 0x80000000 | can_id, 4) == 0
    assert host.write(mapping, 0, 0, 1) == 0
    for place, entry in enumerate(entries, 1):
        assert host.write(mapping, place, entry, 4) == 0
    assert host.write(mapping, 0, len(entries), 1) == 0
    assert host.write(link, 2, kind, 1) == 0
    assert host.write(link, 1, can_id, 4) == 0


@pytest.mark.parametrize(
    ("request_", "answer"),
    [
        ("40 00 10 00 00 00 00 00", "43 00 10 00 92 01 02 00"),  # device type
        ("40 17 10 00 00 00 00 00", "4b 17 10 00 00 00 00 00"),  # producer heartbeat time, 2 bytes
        ("40 01 10 00 00 00 00 00", "4f 01 10 00 00 00 00 00"),  # error register, 1 byte
        ("2b 17 10 00 e8 03 00 00", "60 17 10 00 00 00 00 00"),  # producer heartbeat time 1000 ms
        ("22 17 10 00 e8 03 00 00", "60 17 10 00 00 00 00 00"),  # length not told
        ("40 00 12 01 00 00 00 00", "43 00 12 01 05 06 00 00"),  # SDO server, client to server
        ("40 99 19 00 00 00 00 00", "80 99 19 00 00 00 02 06"),  # no such object
        ("40 18 10 09 00 00 00 00", "80 18 10 09 11 00 09 06"),  # no such subindex
        ("23 00 10 00 00 00 00 00", "80 00 10 00 02 00 01 06"),  # read only
        ("2f 17 10 00 01 00 00 00", "80 17 10 00 13 00 07 06"),  # too short
        ("23 17 10 00 01 00 00 00", "80 17 10 00 12 00 07 06"),  # too long
        ("2b 07 60 00 09 00 00 00", "80 07 60 00 31 00 09 06"),  # above 3
        ("2b 07 60 00 ff ff 00 00", "80 07 60 00 32 00 09 06"),  # below 0
        ("2f 60 60 00 06 00 00 00", "80 60 60 00 30 00 09 06"),  # homing: not a mode of it
        ("a0 00 10 00 00 00 00 00", "80 00 10 00 01 00 04 05"),  # block upload
        ("2f 03 10 00 01 00 00 00", "80 03 10 00 30 00 09 06"),  # only 0 clears the history
    ],
)
def test_sdo_bytes(request_: str, answer: str) -> None:
    assert CanHost().sdo(request_) == answer


def test_text_comes_in_segments_with_toggle_bits() -> None:
    host = CanHost()
    name = GENERIC.device_name.encode("ascii")
    assert host.sdo("40 08 10 00 00 00 00 00") == (b"\x41\x08\x10\x00" + len(name).to_bytes(4, "little")).hex(" ")
    text, toggle = b"", 0
    while len(text) < len(name):
        answer = bytes.fromhex(host.sdo(f"{0x60 | toggle << 4:02x} 00 00 00 00 00 00 00"))
        assert answer[0] >> 4 == toggle
        text += answer[1 : 8 - (answer[0] >> 1 & 7)]
        assert bool(answer[0] & 1) is (len(text) == len(name))
        toggle ^= 1
    assert text == name


def test_wrong_toggle_bit_is_refused() -> None:
    host = CanHost()
    host.sdo("40 08 10 00 00 00 00 00")
    assert host.sdo("70 00 00 00 00 00 00 00") == "80 08 10 00 00 00 03 05"


def test_number_may_come_in_segments() -> None:
    host = CanHost()
    assert host.sdo("21 7a 60 00 04 00 00 00") == "60 7a 60 00 00 00 00 00"
    assert host.sdo("07 d2 04 00 00 00 00 00") == "20 00 00 00 00 00 00 00"
    assert host.read(0x607A) == 1234


def test_boot_up_comes_first_and_once_after_a_reset() -> None:
    host = CanHost()
    assert host.frames == [Frame(0x705, b"\0")]
    host.write(0x6065, 0, 777, 4)
    assert host.send(0x000, "81 05") == [Frame(0x705, b"\0")]
    assert host.read(0x6065, 0, "I") == 0xFFFFFFFF


def test_reset_of_communication_leaves_the_drive_alone() -> None:
    host = CanHost()
    host.write(0x6065, 0, 777, 4)
    host.write(0x1017, 0, 100, 2)
    assert host.send(0x000, "82 00") == [Frame(0x705, b"\0")]
    assert host.read(0x6065, 0, "I") == 777
    assert host.read(0x1017, 0, "H") == 0


def test_stopped_node_answers_no_sdo_and_keeps_its_heartbeat() -> None:
    host = CanHost()
    host.write(0x1017, 0, 50, 2)
    host.send(0x000, "02 05")
    assert host.send(0x605, "40 00 10 00 00 00 00 00") == []
    assert set(host.wait(0.2)) == {Frame(0x705, b"\x04")}
    host.send(0x000, "80 05")
    assert host.send(0x605, "40 00 10 00 00 00 00 00") != []


def test_nmt_for_another_node_is_not_obeyed() -> None:
    host = CanHost()
    host.write(0x1017, 0, 50, 2)
    host.send(0x000, "01 06")
    assert set(host.wait(0.1)) == {Frame(0x705, PRE_OPERATIONAL)}


def test_heartbeat_keeps_its_period() -> None:
    host = CanHost()
    host.write(0x1017, 0, 100, 2)
    host.wait(0.01)
    assert len(host.wait(10.0)) == 100


def test_pdo_is_changed_in_the_order_of_the_standard_only() -> None:
    host = CanHost()
    assert host.write(0x1A00, 0, 0, 1) == 0x06010000  # TPDO 1 exists
    assert host.write(0x1800, 1, 0x80000185, 4) == 0
    assert host.write(0x1A00, 1, 0x60640020, 4) == 0x06010000  # still counts one object
    assert host.write(0x1A00, 0, 0, 1) == 0
    assert host.write(0x1A00, 1, 0x60640020, 4) == 0
    assert host.write(0x1A00, 0, 1, 1) == 0
    assert host.write(0x1800, 1, 0x00000185, 4) == 0
    assert host.write(0x1800, 1, 0x00000186, 4) == 0x06090030  # another identifier while it exists


@pytest.mark.parametrize(
    ("entry", "code"),
    [
        (0x60640010, 0x06040041),  # 16 bits of a 32-bit object
        (0x65020020, 0x06040041),  # not mappable
        (0x60990020, 0x06020000),  # no such object
        (0x60C20320, 0x06090011),  # no such subindex
    ],
)
def test_wrong_object_is_not_mapped(entry: int, code: int) -> None:
    host = CanHost()
    host.write(0x1A01, 0, 0, 1)
    assert host.write(0x1A01, 1, entry, 4) == code


def test_measurement_is_not_mapped_into_an_rpdo() -> None:
    assert CanHost().write(0x1601, 1, 0x60640020, 4) == 0x06040041


def test_more_than_eight_bytes_are_refused() -> None:
    host = CanHost()
    for place in (1, 2, 3):
        assert host.write(0x1A01, place, 0x60640020, 4) == 0
    assert host.write(0x1A01, 0, 3, 1) == 0x06040042


@pytest.mark.parametrize("kind", [241, 252, 253])
def test_transmission_type_that_is_not_there_is_refused(kind: int) -> None:
    assert CanHost().write(0x1801, 2, kind, 1) == 0x06090030


def test_synchronous_tpdo_comes_at_every_nth_sync() -> None:
    host = _operational(CanHost())
    _map(host, 0x1801, 0x1A01, 0x285, 3, 0x60640020, 0x606C0020)
    assert [len(host.send(0x080)) for _ in range(6)] == [0, 0, 1, 0, 0, 1]
    (frame,) = [frame for _ in range(3) for frame in host.send(0x080)]
    assert frame == Frame(0x285, bytes(8))


def test_pdos_live_in_operational_only() -> None:
    host = CanHost()
    _map(host, 0x1801, 0x1A01, 0x285, 1, 0x60640020)
    assert host.send(0x080) == []
    assert len(_operational(host).send(0x080)) == 1
    host.send(0x000, "80 05")
    assert host.send(0x080) == []


def test_event_driven_tpdo_comes_at_a_change_and_at_its_timer() -> None:
    host = _operational(CanHost())
    assert Frame(0x185, bytes.fromhex("50 02")) in host.wait(0.002)  # TPDO 1: the statusword, at once
    assert host.wait(0.5) == []
    host.write(0x6040, 0, 6, 2)
    assert host.wait(0.01) == [Frame(0x185, bytes.fromhex("31 02"))]
    host.write(0x1800, 5, 100, 2)
    assert len(host.wait(1.0)) == 10


def test_inhibit_time_holds_events_back() -> None:
    host = _operational(CanHost())
    host.write(0x1800, 3, 500, 2)  # 50 ms
    host.wait(0.1)
    host.write(0x6040, 0, 6, 2)
    assert len(host.wait(0.01)) == 1
    host.write(0x6040, 0, 7, 2)
    assert host.wait(0.03) == []
    assert host.wait(0.03) == [Frame(0x185, bytes.fromhex("33 02"))]


def test_synchronous_rpdo_waits_for_its_sync_and_the_last_counts() -> None:
    host = _operational(CanHost())
    _map(host, 0x1401, 0x1601, 0x305, 1, 0x60710010, 0x60B20010)
    host.send(0x305, "0a 00 14 00")
    host.send(0x305, "0b 00 15 00")
    assert host.read(0x6071, 0, "h") == 0
    host.send(0x080)
    assert (host.read(0x6071, 0, "h"), host.read(0x60B2, 0, "h")) == (11, 21)


def test_rpdo_of_wrong_length_is_told_of() -> None:
    host = _operational(CanHost())
    _map(host, 0x1401, 0x1601, 0x305, 255, 0x60710010)
    assert host.send(0x305, "0a") == [Frame(0x085, bytes.fromhex("10 82 11 00 00 00 00 00"))]
    assert host.read(0x6071, 0, "h") == 0
    assert host.send(0x305, "0a 00 00") == [Frame(0x085, bytes.fromhex("20 82 11 00 00 00 00 00"))]
    assert host.read(0x6071, 0, "h") == 10
    assert host.read(0x1001, 0, "B") == 0  # over as it happens
    assert [host.read(0x1003, place, "I") for place in (1, 2)] == [0x8220, 0x8210]


def test_fault_is_told_kept_and_taken_back() -> None:
    host = CanHost()
    host.device.axis.meet(OverCurrent(start_s=0.0, duration_s=0.1))
    assert host.wait(0.01) == [Frame(0x085, bytes.fromhex("10 23 03 00 00 00 00 00"))]
    assert host.read(0x1001, 0, "B") == 0x03
    assert (host.read(0x1003, 0, "B"), host.read(0x1003, 1, "I")) == (1, 0x2310)
    host.wait(0.2)
    host.write(0x6040, 0, 0x80, 2)
    assert host.wait(0.01) == [Frame(0x085, bytes(8))]
    assert host.write(0x1003, 0, 0, 1) == 0
    assert host.read(0x1003, 1, "I") == 0


def test_missing_master_is_noticed_from_its_first_heartbeat_on() -> None:
    host = CanHost()
    assert host.write(0x1016, 1, MASTER << 16 | 100, 4) == 0
    assert host.write(0x1016, 2, MASTER << 16 | 50, 4) == 0x06040043  # that node is watched already
    assert host.write(0x1016, 1, MASTER << 16 | 100, 4) == 0
    assert host.wait(1.0) == []
    host.send(0x77F, OPERATIONAL)
    assert host.wait(0.099) == []
    assert host.wait(0.01) == [Frame(0x085, bytes.fromhex("30 81 11 00 00 00 00 00"))]
    assert host.wait(1.0) == []
    assert host.send(0x77F, OPERATIONAL) == [Frame(0x085, bytes(8))]


@pytest.mark.parametrize(("behavior", "state"), [(0, PRE_OPERATIONAL), (1, OPERATIONAL), (2, b"\x04")])
def test_node_without_master_goes_where_it_was_told(behavior: int, state: bytes) -> None:
    host = _operational(CanHost())
    host.write(0x1029, 1, behavior, 1)
    host.write(0x1016, 1, MASTER << 16 | 100, 4)
    host.write(0x1017, 0, 10, 2)
    host.send(0x77F, OPERATIONAL)
    host.wait(0.2)
    assert {frame.data for frame in host.wait(0.1) if frame.can_id == 0x705} == {state}


@pytest.mark.parametrize("family", [GENERIC, EPOS4])
def test_eds_is_read_by_canopen(family, tmp_path) -> None:
    host = CanHost(family)
    file = tmp_path / "drive.eds"
    file.write_text(eds_text(host.device.dictionary.objects.values(), family.device_name))
    book = canopen.import_od(str(file), NODE)
    assert set(book) == set(host.device.dictionary.objects)
    assert book[0x1800][1].default == 0x185
    assert book[0x6064].data_type == canopen.objectdictionary.INTEGER32
    assert book[0x6041].pdo_mappable
    assert not book[0x6502].writable
