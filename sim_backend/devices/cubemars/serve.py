"""Starts a CubeMars actuator on a CAN bus."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.can.ports import port_of
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.process import RunningDevice


@dataclass(frozen=True, kw_only=True)
class CubemarsSimulation:
    """An actuator, its joint and its bus.

    Attributes:
        motor_id: to which it listens.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
        interface, channel: as `sim_backend.devices.can.ports.BusChoice` has them.
        link: symbolic link to put on the pseudo-terminal; None: none.
        preset, plant, seed: the joint.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    motor_id: int = 1
    ranges: tuple[float, float, float] = (12.5, 50.0, 18.0)
    interface: str = "slcan"
    channel: str = "0"
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_cubemars(settings: CubemarsSimulation) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be.
        OSError: a port is taken.
    """
    parameters = behind_a_drive(settings.preset, None, settings.plant)
    device = CubemarsMotor(parameters, settings.motor_id, settings.ranges, settings.seed)
    return RunningDevice(device, port_of(device, settings), settings.side_port, settings.patience_s)
