"""Starts moteus controllers behind an adapter on a pseudo-terminal."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.can.ports import port_of
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_port import SerialPort
from sim_backend.devices.moteus.adapter import FdcanusbAdapter
from sim_backend.devices.moteus.controller import MoteusController
from sim_backend.devices.moteus.node import MoteusOnBus
from sim_backend.devices.process import RunningDevice


@dataclass(frozen=True, kw_only=True)
class MoteusBusSettings:
    """Controllers, their joints and their adapter.

    Attributes:
        ids: of each.
        interface, channel: a CAN-FD bus of python-can in the place of the adapter; "": the adapter.
        is_uart: whether it is a controller's own UART, whose lines have checksums.
        baud: pace of the line; None is as fast as the machine.
        link: symbolic link to put on the port; None: none.
        preset, plant: of the joint behind each.
        seed: of the first; the others have the next ones.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    ids: tuple[int, ...] = (1,)
    interface: str = ""
    channel: str = ""
    is_uart: bool = False
    baud: int | None = None
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_moteus(settings: MoteusBusSettings) -> RunningDevice:
    """Start them. The port stays where it is while the line is not disconnected.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = behind_a_drive(settings.preset, None, settings.plant)
    controllers = [
        MoteusController(parameters, servo_id, settings.seed + place) for place, servo_id in enumerate(settings.ids)
    ]
    if settings.interface:
        on_bus = MoteusOnBus(controllers)
        return RunningDevice(on_bus, port_of(on_bus, settings), settings.side_port, settings.patience_s)
    device = FdcanusbAdapter(controllers, settings.is_uart)
    return RunningDevice(
        device,
        lambda place: SerialPort(device, place.clock, Line(settings.baud, place.faults, settings.seed), settings.link),
        settings.side_port,
        settings.patience_s,
    )
