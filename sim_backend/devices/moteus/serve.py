"""Starts moteus controllers behind an adapter on a pseudo-terminal, or on a CAN-FD bus without one."""

from collections.abc import Sequence
from dataclasses import dataclass
from threading import RLock

from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.devices.can.ports import port_of
from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.moteus.adapter import FdcanusbAdapter, padded
from sim_backend.devices.moteus.controller import MoteusController
from sim_backend.devices.process import RunningDevice


@dataclass(frozen=True, kw_only=True)
class MoteusBusSettings(ServedOnLine):
    """Controllers, their joints and their adapter.

    Attributes:
        ids: of each.
        interface, channel: a CAN-FD bus of python-can in the place of the adapter; "": the adapter.
        is_uart: whether it is a controller's own UART, whose lines have checksums.
    """

    ids: tuple[int, ...] = (1,)
    interface: str = ""
    channel: str = ""
    is_uart: bool = False


class MoteusOnBus:
    """The controllers of a bus. Loads, faults and truth are the first one's."""

    def __init__(self, controllers: Sequence[MoteusController]) -> None:
        self.axis = controllers[0].axis
        self.lock = RLock()
        self.node = QuietNode()
        self._controllers = controllers

    def advance_to(self, time_s: float) -> None:
        """Let time pass."""
        for one in self._controllers:
            one.axis.advance_to(time_s)

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        source, destination = frame.can_id >> 8 & 0x7F, frame.can_id & 0x7F
        for one in self._controllers:
            if frame.fd and one.servo_id == destination:
                answer = one.hear(frame.data, bool(frame.can_id & 0x8000))
                if answer:
                    self.node.send(Frame(one.servo_id << 8 | source, padded(answer), extended=True, fd=True))

    def report(self) -> dict[str, object]:
        """Say what the first controller is about."""
        return self._controllers[0].report()


def serve_moteus(settings: MoteusBusSettings) -> RunningDevice:
    """Start them.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = settings.joint()
    controllers = [
        MoteusController(parameters, servo_id, settings.seed + place) for place, servo_id in enumerate(settings.ids)
    ]
    if settings.interface:
        on_bus = MoteusOnBus(controllers)
        return settings.running(on_bus, port_of(on_bus, settings, settings.interface, settings.channel))
    return settings.on_pseudo_terminal(FdcanusbAdapter(controllers, settings.is_uart))
