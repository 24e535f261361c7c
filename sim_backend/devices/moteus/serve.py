"""Starts moteus controllers behind an adapter on a pseudo-terminal, or on a CAN-FD bus without one."""

from collections.abc import Sequence
from dataclasses import dataclass

from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.devices.can.ports import port_of
from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.moteus.adapter import Controllers, FdcanusbAdapter
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


class MoteusOnBus(Controllers):
    """The controllers without an adapter."""

    def __init__(self, controllers: Sequence[MoteusController]) -> None:
        super().__init__(controllers)
        self.node = QuietNode()

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        for can_id, data in self.answers(frame.can_id, frame.data) if frame.fd else ():
            self.node.send(Frame(can_id, data, extended=True, fd=True))


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
