"""`friction-bench simulate-device cubemars`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import Simulated
from bench.drives.device import DeviceOptions, started


def simulate(
    motor: Annotated[int, typer.Option(min=1, max=127, help="CAN id of the actuator.")] = 1,
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
    """A CubeMars actuator (MIT protocol) on a CAN bus; its ranges fit the joint of the paper."""
    from sim_backend.devices.cubemars.serve import CubemarsSimulation, serve_cubemars

    ranges = position_range, speed_range, torque_range
    settings = CubemarsSimulation(
        motor_id=motor, ranges=ranges, interface=interface, channel=channel, **options.values()
    )
    device = started(lambda: serve_cubemars(settings))
    return Simulated(device, "CubeMars, MIT protocol", {
        "kind": "cubemars", "interface": interface, "channel": device.path, "motor_id": motor,
        "position_range_rad": position_range, "speed_range_rad_s": speed_range, "torque_range_n_m": torque_range,
        "accept_no_watchdog": True, "is_simulated": True,
    })  # fmt: skip
