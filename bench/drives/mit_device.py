"""`friction-bench simulate-device` of actuators whose torque is their feed-forward term: they differ in name and id."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulate, Simulated
from bench.drives.device import Channel, DeviceOptions, Interface, started

if TYPE_CHECKING:
    from sim_backend.devices.mit.serve import Make


def simulates(
    kind: str, title: str, summary: str, motor_id: int, maker: Callable[[], "Make"], further: DriveTable
) -> Simulate:
    """The command of a kind.

    Args:
        kind: its name.
        title: of the device, for people.
        summary: of the command.
        motor_id: where nothing else is asked for.
        maker: imports what makes the actuator.
        further: keys of `[drive]` beside its place and its ranges.
    """

    def simulate(
        motor: Annotated[int, typer.Option(min=1, max=127, help="CAN id of the actuator.")] = motor_id,
        position_range: Annotated[float, typer.Option(min=0.1, max=1000, help="Range of positions [rad].")] = 100.0,
        speed_range: Annotated[float, typer.Option(min=0.1, max=1000, help="Range of speeds [rad/s].")] = 200.0,
        torque_range: Annotated[float, typer.Option(min=0.01, max=1000, help="Range of torques [N m].")] = 0.5,
        interface: Interface = "slcan",
        channel: Channel = "0",
        *,
        options: DeviceOptions,
    ) -> Simulated:
        from sim_backend.devices.mit.serve import MitSimulation, serve_mit

        ranges = position_range, speed_range, torque_range
        settings = MitSimulation(
            motor_id=motor, ranges=ranges, interface=interface, channel=channel, **options.values()
        )
        device = started(lambda: serve_mit(maker(), settings))
        return Simulated(device, title, {
            "kind": kind, "interface": interface, "channel": device.path, "motor_id": motor,
            "position_range_rad": position_range, "speed_range_rad_s": speed_range, "torque_range_n_m": torque_range,
            **further,
        })  # fmt: skip

    simulate.__doc__ = summary
    return simulate
