"""python-can's bus inside a process, in virtual time: no thread receives, who looks brings a device to the present."""

import time
from queue import Empty
from typing import Any

import can
from can.interfaces.virtual import VirtualBus

from sim_backend.devices.can.ports import BusPort
from tests.commission.virtual_time import TIME

_FRAME_S = 130e-6
_LOOK_S = 1e-3  # a tick of a device, which may speak by itself
_send = VirtualBus.send
_PORTS: list["VirtualBusPort"] = []


class VirtualBusPort(BusPort):
    """A device on such a bus."""

    def start(self) -> None:
        """It is on the bus, and boots."""
        _PORTS.append(self)
        with self._device.lock:
            self._device.node.boot()

    def close(self) -> None:
        """Leave the bus."""
        _PORTS.remove(self)
        super().close()

    def look(self) -> None:
        """Bring the device to the present, and give it what has come."""
        with self._device.lock:
            self._device.advance_to(self._clock.now_s())
            while True:
                try:
                    message = self._bus.queue.get_nowait()  # type: ignore[attr-defined]
                except Empty:
                    return
                self._receive(message)


def bus_port(device: Any, clock: Any, interface: str, channel: str, more: dict[str, Any] | None = None) -> BusPort:
    """The port of a device on a bus; one of the operating system's stays as it is."""
    made = VirtualBusPort if interface == "virtual" else BusPort
    return made(device, clock, interface, channel, more)


def look() -> None:
    """Bring every device to the present."""
    for port in list(_PORTS):
        port.look()


def _receive(bus: VirtualBus, timeout: float | None) -> tuple[can.Message | None, bool]:
    end_s = time.monotonic() + (1e9 if timeout is None else timeout)
    while True:
        look()
        try:
            return bus.queue.get_nowait(), False
        except Empty:
            left_s = end_s - time.monotonic()
            if left_s <= 0.0:
                return None, False
            time.sleep(min(left_s, _LOOK_S))


def _send_and_wait(bus: VirtualBus, message: can.Message, timeout: float | None = None) -> None:
    TIME.advance(_FRAME_S)
    _send(bus, message, timeout)


def install() -> None:
    """From now on, in this process."""
    VirtualBus._recv_internal = _receive  # type: ignore[assignment, method-assign]
    VirtualBus.send = _send_and_wait  # type: ignore[assignment, method-assign]
