"""Starts an ODrive axis on a CAN bus."""

from dataclasses import dataclass

from sim_backend.devices.can.ports import ServedOnBus
from sim_backend.devices.odrive.axis import OdriveAxis
from sim_backend.devices.process import RunningDevice


@dataclass(frozen=True, kw_only=True)
class OdriveSimulation(ServedOnBus):
    """An axis, its joint and its bus.

    Attributes:
        node_id: 0 .. 62.
        watchdog_s: of axis0.config [s]; None: not enabled.
    """

    node_id: int = 0
    watchdog_s: float | None = 0.2


def serve_odrive(settings: OdriveSimulation) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be.
        OSError: a port is taken.
    """
    return settings.on_bus(OdriveAxis(settings.joint(), settings.node_id, settings.watchdog_s, settings.seed))
