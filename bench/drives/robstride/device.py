"""`friction-bench simulate-device robstride`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import Simulated
from bench.drives.device import DeviceOptions, started


def simulate(
    motor: Annotated[int, typer.Option(min=1, max=127, help="CAN id of the actuator.")] = 127,
    position_range: Annotated[float, typer.Option(min=0.1, max=1000, help="Range of positions [rad].")] = 100.0,
    speed_range: Annotated[float, typer.Option(min=0.1, max=1000, help="Range of speeds [rad/s].")] = 200.0,
    torque_range: Annotated[float, typer.Option(min=0.01, max=1000, help="Range of torques [N m].")] = 0.5,
    interface: Annotated[
        str, typer.Option(help="slcan (a pseudo-terminal), or any interface of python-can: socketcan, pcan ...")
    ] = "slcan",
    channel: Annotated[str, typer.Option(help="Of the interface: vcan0 ...")] = "0",
    *,
    options: DeviceOptions,
) -> Simulated:
    """A RobStride actuator (its own protocol) on a CAN bus; its ranges fit the joint of the paper."""
    from sim_backend.devices.robstride.serve import RobstrideSimulation, serve_robstride

    ranges = position_range, speed_range, torque_range
    settings = RobstrideSimulation(
        motor_id=motor, ranges=ranges, interface=interface, channel=channel, **options.values()
    )
    device = started(lambda: serve_robstride(settings))
    return Simulated(device, "RobStride, its own protocol", {
        "kind": "robstride", "interface": interface, "channel": device.path, "motor_id": motor,
        "position_range_rad": position_range, "speed_range_rad_s": speed_range, "torque_range_n_m": torque_range,
    })  # fmt: skip
