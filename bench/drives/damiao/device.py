"""`friction-bench simulate-device damiao`."""

from functools import partial
from typing import Annotated

import typer

from bench.config.drives.simulated_device import Simulated
from bench.drives.device import Channel, DeviceOptions, Interface, started


def simulate(
    motor: Annotated[int, typer.Option(min=1, max=0x7FE, help="ESC_ID of the actuator.")] = 1,
    feedback: Annotated[int, typer.Option(min=0, max=0x7FE, help="MST_ID of the actuator.")] = 0x11,
    position_range: Annotated[float, typer.Option(min=0.1, max=1000, help="PMAX [rad].")] = 100.0,
    speed_range: Annotated[float, typer.Option(min=0.1, max=1000, help="VMAX [rad/s].")] = 200.0,
    torque_range: Annotated[float, typer.Option(min=0.01, max=1000, help="TMAX [N m].")] = 0.5,
    interface: Interface = "slcan",
    channel: Channel = "0",
    *,
    options: DeviceOptions,
) -> Simulated:
    """A Damiao actuator on a CAN bus (MIT protocol); its ranges fit the joint of the paper."""
    from sim_backend.devices.damiao.motor import DamiaoMotor
    from sim_backend.devices.mit.serve import MitSimulation, serve_mit

    ranges = position_range, speed_range, torque_range
    settings = MitSimulation(motor_id=motor, ranges=ranges, interface=interface, channel=channel, **options.values())
    device = started(lambda: serve_mit(partial(DamiaoMotor, feedback_id=feedback), settings))
    return Simulated(device, "Damiao, MIT protocol", {
        "kind": "damiao", "interface": interface, "channel": device.path, "motor_id": motor, "feedback_id": feedback,
    })  # fmt: skip
