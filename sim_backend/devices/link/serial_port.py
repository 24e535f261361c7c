"""The thread that carries bytes between a pseudo-terminal and a device, at the line's pace and with its faults."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from sim_backend.devices.axis import Device
from sim_backend.devices.link.faults import Direction
from sim_backend.devices.link.line import Line, pause_until
from sim_backend.devices.link.port import LOOK_UP_S, PortThread
from sim_backend.devices.link.pseudo_terminal import PseudoTerminal
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.served import Served
from sim_backend.devices.wall_time import WallTime


class ByteDevice(Device, Protocol):
    """A device on a serial line or a stream."""

    def receive(self, data: bytes, time_s: float) -> bytes:
        """Take bytes that have arrived at a time [s], and return what the device answers."""

    def connect(self) -> None:
        """Somebody has plugged in anew: forget half of a packet."""


class SerialPort(PortThread):
    """A device behind a serial port."""

    def __init__(self, device: ByteDevice, clock: WallTime, line: Line, link: Path | None = None) -> None:
        super().__init__(line, clock, "device serial port")
        self._device = device
        self._link = link
        self._terminal: PseudoTerminal | None = PseudoTerminal(link)
        self.path = self._terminal.path

    def _serve(self) -> None:
        terminal = self._plugged()
        data = terminal.read(LOOK_UP_S)
        if data:
            self._clock.hear()
            self._carry(terminal, data)

    def _carry(self, terminal: PseudoTerminal, data: bytes) -> None:
        for request in self._line.carry(Direction.TO_DEVICE, data, self._clock.now_s()):
            pause_until(self._clock, request.at_s)
            now_s = self._clock.now_s()
            with self._device.lock:
                self._device.advance_to(now_s)
                answer = self._device.receive(request.data, now_s)
            if answer:
                for delivery in self._line.carry(Direction.FROM_DEVICE, answer, request.at_s):
                    pause_until(self._clock, delivery.at_s)
                    terminal.write(delivery.data)

    def _plugged(self) -> PseudoTerminal:
        if self._terminal is None:
            self._terminal = PseudoTerminal(self._link)
            self.path = self._terminal.path
            with self._device.lock:
                self._device.connect()
        return self._terminal

    def _unplug(self) -> None:
        if self._terminal is not None:
            self._terminal.close()
            self._terminal = None


@dataclass(frozen=True, kw_only=True)
class ServedOnLine(Served):
    """Its joint and its line.

    Attributes:
        baud: pace of the line; None is as fast as the machine.
    """

    baud: int | None = None

    def on_pseudo_terminal(self, device: ByteDevice) -> RunningDevice:
        """Return the device at work. Its port stays where it is while the line is not disconnected.

        Raises:
            OSError: the link or the side channel's port is taken.
        """
        return self.running(
            device, lambda place: SerialPort(device, place.clock, Line(self.baud, place.faults, self.seed), self.link)
        )
