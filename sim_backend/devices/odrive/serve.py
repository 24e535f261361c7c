"""Starts an ODrive axis on a CAN bus."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.can.ports import port_of
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.odrive.axis import OdriveAxis
from sim_backend.devices.process import RunningDevice


@dataclass(frozen=True, kw_only=True)
class OdriveSimulation:
    """An axis, its joint and its bus.

    Attributes:
        node_id: 0 .. 62.
        watchdog_s: of axis0.config [s]; None: not enabled.
        interface, channel: as `sim_backend.devices.can.ports.BusChoice` has them.
        link: symbolic link to put on the pseudo-terminal; None: none.
        preset, plant, seed: the joint.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    node_id: int = 0
    watchdog_s: float | None = 0.2
    interface: str = "slcan"
    channel: str = "0"
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_odrive(settings: OdriveSimulation) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be.
        OSError: a port is taken.
    """
    parameters = behind_a_drive(settings.preset, None, settings.plant)
    device = OdriveAxis(parameters, settings.node_id, settings.watchdog_s, settings.seed)
    return RunningDevice(device, port_of(device, settings), settings.side_port, settings.patience_s)
