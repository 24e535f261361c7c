"""The bus at its worst, played by a bus of python-can that does as it is told."""

import errno
import threading
import time

import can
import pytest

from drivers.can_bus.bus import bounded
from drivers.can_bus.port import CanPort
from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia301.link import BusPort, CanLink
from drivers.errors import DriveConnectionError

# as SocketCAN says it, and as python-can does after a wait
FULL = (
    can.CanOperationError("Failed to transmit: No buffer space available", errno.ENOBUFS),
    can.CanOperationError("Transmit buffer full"),
)


class ScriptedBus:
    """Raises or returns what is in its lists, one item per call."""

    def __init__(self, sends=(), receives=()) -> None:
        self.sends, self.receives, self.sent = list(sends), list(receives), []

    def send(self, message, timeout=None):
        outcome = self.sends.pop(0) if self.sends else None
        if outcome is not None:
            raise outcome
        self.sent.append(message)

    def recv(self, timeout):
        outcome = self.receives.pop(0) if self.receives else None
        if isinstance(outcome, Exception):
            raise outcome
        return outcome


def _port(**script):
    port = CanPort(BusSettings("virtual", "x"))
    port.close()
    port._bus = ScriptedBus(**script)
    return port


def _link(interface="virtual", **script):
    port = BusPort(BusSettings(interface, "x"))
    port._bus = ScriptedBus(**script)
    link = CanLink(port, "x node 5")
    link.open()
    return link


def _frame(cob, data=b""):
    return can.Message(arbitration_id=cob, data=data, is_extended_id=False)


@pytest.mark.parametrize("full", FULL)
def test_a_full_transmit_buffer_is_waited_for(full):
    link, port = _link(sends=[full] * 2), _port(sends=[full] * 2)
    link.send_message(0x205, b"\x0f\0\0\0")
    port.send(0x205, b"\x0f\0\0\0")
    for bus in (link.bus, port._bus):
        assert [(message.arbitration_id, bytes(message.data)) for message in bus.sent] == [(0x205, b"\x0f\0\0\0")]


@pytest.mark.parametrize("full", FULL)
def test_a_transmit_buffer_that_stays_full_is_an_error_in_bounded_time(full):
    link, port = _link(sends=[full] * 10_000), _port(sends=[full] * 10_000)
    for one, why in ((link, "the transmit buffer stays full: nobody acknowledges"), (port, "or nobody acknowledges")):
        start_s = time.perf_counter()
        with pytest.raises(DriveConnectionError, match=f"sending failed: .*{why}.*; check cable"):
            one.send_prepared(_frame(0x80))
        assert time.perf_counter() - start_s < 2.0


@pytest.mark.parametrize("error", [can.CanOperationError("Could not write"), BrokenPipeError("gone"), OSError("gone")])
def test_a_port_that_is_gone_is_an_error_at_once(error):
    for one in (_link(sends=[error, None]), _port(sends=[error, None])):
        with pytest.raises(DriveConnectionError, match=r"sending failed: .*open the drive again"):
            one.send_prepared(_frame(0x80))
    with pytest.raises(DriveConnectionError, match=r"receiving failed: .*open the drive again"):
        _link(receives=[error]).receive(0.01)


def test_a_line_that_is_no_frame_is_skipped_and_the_next_one_is_read():
    heard = []
    link = _link(receives=[ValueError("invalid literal for int()"), IndexError(), _frame(0x185, b"\x01")])
    link.subscribe(0x185, lambda _id, data, _time: heard.append(bytes(data)))
    link.drain()
    assert heard == [b"\x01"]
    assert link.garbled == 2


def test_what_is_wrong_in_the_driver_itself_is_not_swallowed():
    link = _link(receives=[_frame(0x185)])

    def broken(_id, _data, _time):
        raise ZeroDivisionError

    link.subscribe(0x185, broken)
    with pytest.raises(ZeroDivisionError):
        link.drain()


def test_bus_off_is_an_error_and_other_error_frames_are_counted():
    off = can.Message(arbitration_id=0x40, is_error_frame=True, data=bytes(8))
    warning = can.Message(arbitration_id=0x04, is_error_frame=True, data=bytes(8))
    link = _link("socketcan", receives=[warning, off])
    assert link.receive(0.0)
    with pytest.raises(DriveConnectionError, match="the bus is off"):
        link.receive(0.0)
    assert link.garbled == 2


def test_a_babbling_node_does_not_hold_the_loop():
    link = _link(receives=[_frame(0x7F1)] * 5000)
    link.drain()
    assert len(link.bus.receives) == 3000


def test_a_closed_bus_says_so():
    link = CanLink(BusPort(BusSettings("virtual", "x")), "x node 5")
    for call in (lambda: link.send_message(0, b""), lambda: link.receive(0.0)):
        with pytest.raises(DriveConnectionError, match="open the drive first"):
            call()
    link.close()


def test_a_call_that_hangs_is_given_up_and_its_late_result_is_undone():
    release, undone = threading.Event(), threading.Event()
    with pytest.raises(TimeoutError, match=r"not done within 0.05 s"):
        bounded(lambda: release.wait(10.0), 0.05, undo=lambda _result: undone.set())
    release.set()
    assert undone.wait(5.0)


def test_a_bounded_call_gives_its_result_or_its_error():
    assert bounded(lambda: 5, 5.0) == 5
    with pytest.raises(ZeroDivisionError):
        bounded(lambda: 1 // 0, 5.0)


def test_every_link_to_a_bus_hears_what_one_of_them_receives():
    link = _link(receives=[_frame(0x185), _frame(0x186)])
    other = CanLink(link.port, "x node 6")
    other.open()
    heard = []
    for number, one in ((0x185, link), (0x186, other)):
        one.subscribe(number, lambda cob_id, *_frame: heard.append(cob_id))
    link.drain()
    assert heard == [0x185, 0x186]


def test_a_bus_is_closed_with_its_last_link():
    link = _link()
    bus, closed = link.bus, []
    bus.shutdown = lambda: closed.append(True)
    other = CanLink(link.port, "x node 6")
    other.open()
    link.close()
    assert not closed
    other.close()
    assert closed
