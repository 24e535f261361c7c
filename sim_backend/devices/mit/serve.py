"""Starts an actuator whose torque is its feed-forward term, of any make, on a CAN bus."""

from collections.abc import Callable
from dataclasses import dataclass

from sim_backend.devices.can.ports import ServedOnBus
from sim_backend.devices.mit.motor import MitMotor
from sim_backend.devices.mit.short_frames import Top
from sim_backend.devices.process import RunningDevice
from sim_backend.plant.parameters import PlantParameters

Make = Callable[[PlantParameters, int, Top, int], MitMotor]
"""An actuator of a joint, its id, its ranges and a seed."""


@dataclass(frozen=True, kw_only=True)
class MitSimulation(ServedOnBus):
    """An actuator, its joint and its bus.

    Attributes:
        motor_id: to which it listens.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
    """

    motor_id: int = 1
    ranges: Top = (100.0, 200.0, 0.5)


def serve_mit(make: Make, settings: MitSimulation) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be.
        OSError: a port is taken.
    """
    return settings.on_bus(make(settings.joint(), settings.motor_id, settings.ranges, settings.seed))
