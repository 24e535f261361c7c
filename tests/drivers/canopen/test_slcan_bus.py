"""Serial adapter: the lines of the Lawicel protocol, both ways, on a pseudo-terminal."""

import os
import time
import tty
from contextlib import suppress

import can
import pytest

from drivers.can_bus.bus import close_bus, open_bus
from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia301.link import BusPort, CanLink
from drivers.errors import DriveConnectionError


@pytest.fixture
def adapter():
    """The adapter's end of the line, and the path of the host's."""
    end, host = os.openpty()
    tty.setraw(host)
    os.set_blocking(end, False)
    yield end, os.ttyname(host)
    for descriptor in (end, host):
        with suppress(OSError):  # a test may have closed it
            os.close(descriptor)


@pytest.fixture
def bus(adapter):
    opened = open_bus(BusSettings("slcan", adapter[1]), "test")
    yield opened
    close_bus(opened)


def _written(end: int, last: bytes) -> bytes:
    """What the host has written, to the line `last`; a terminal may hand it over in parts."""
    deadline_s = time.perf_counter() + 2.0
    heard = b""
    while time.perf_counter() < deadline_s:
        with suppress(BlockingIOError):
            heard += os.read(end, 4096)
        if heard.endswith(last + b"\r"):
            return heard
        time.sleep(0.001)
    pytest.fail(f"{last!r} was not written; {heard!r} was")


def _last_line(end: int, last: bytes) -> bytes:
    """The whole last line; the channel is opened twice, and the second time may be heard late."""
    return _written(end, last).split(b"\r")[-2]


def test_the_channel_is_opened_at_its_bit_rate(adapter, bus):
    lines = _written(adapter[0], b"O").split(b"\r")
    assert lines.index(b"C") < lines.index(b"S8") < len(lines) - 1 - lines[::-1].index(b"O")


def test_frames_are_lines(adapter, bus):
    _written(adapter[0], b"O")
    bus.send(can.Message(arbitration_id=0x205, data=bytes.fromhex("0f0038ff"), is_extended_id=False))
    assert _last_line(adapter[0], b"t20540F0038FF") == b"t20540F0038FF"
    bus.send(can.Message(arbitration_id=0x80, data=b"", is_extended_id=False))
    assert _last_line(adapter[0], b"t0800") == b"t0800"


def test_frames_come_one_by_one_however_the_line_is_cut(adapter, bus):
    line = b"z\rt18543702E803\rt28580010000000000000\r\r"
    for place in range(len(line)):
        os.write(adapter[0], line[place : place + 1])
    frames = [bus.recv(1.0) for _ in range(2)]
    assert [(frame.arbitration_id, bytes(frame.data).hex()) for frame in frames] == [
        (0x185, "3702e803"), (0x285, "0010000000000000"),
    ]  # fmt: skip
    assert bus.recv(0.0) is None


def test_answers_of_the_adapter_do_not_hide_the_frames_behind_them(adapter, bus):
    os.write(adapter[0], b"\r\az\rV1013\rN1234\rF00\rt70517F\r")
    frame = bus.recv(1.0)
    assert (frame.arbitration_id, bytes(frame.data)) == (0x705, b"\x7f")


def test_not_waiting_means_not_waiting(bus):
    start_s = time.perf_counter()
    for _ in range(200):
        assert bus.recv(0.0) is None
    assert time.perf_counter() - start_s < 0.2, "python-can's own waits 1 ms each time"


def test_garbage_on_the_line_costs_its_line_only(adapter):
    link = CanLink(BusPort(BusSettings("slcan", adapter[1])), "test")
    link.open()
    heard = []
    link.subscribe(0x705, lambda _id, data, _time: heard.append(bytes(data)))
    os.write(adapter[0], b"t7x51\rt\rt7059\xff\xfe\rt70515\xff\rgarbage\rt705105\r")
    deadline_s = time.perf_counter() + 2.0
    while not heard and time.perf_counter() < deadline_s:
        link.receive(0.1)
    assert heard == [b"\x05"]
    assert link.garbled == 4
    link.close()


def test_a_port_that_is_pulled_is_an_error_and_closes(adapter):
    link = CanLink(BusPort(BusSettings("slcan", adapter[1])), "test")
    link.open()
    link.send_message(0x80, b"")
    os.close(adapter[0])
    with pytest.raises(DriveConnectionError, match="receiving failed"):
        link.receive(1.0)
    start_s = time.perf_counter()
    link.close()
    assert time.perf_counter() - start_s < 2.0
