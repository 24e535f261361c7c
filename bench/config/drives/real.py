"""What every real drive's settings share: signs and zero, and the joint that comes of them and the rig."""

from collections.abc import Mapping
from typing import Any, Literal

from bench.config.drives.kind import DriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.joint import JointScale

Sign = Literal[1, -1]
Bitrate = Literal[10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 1_000_000]


class RealDriveSettings(DriveSettings):
    """Signs, zero, loads. `friction-bench doctor` prints what stands now, and checks it with a small move."""

    motor_sign: Sign = quantity(1, "", "-1 where a positive demand turns the joint to negative angles")
    encoder_sign: Sign = quantity(1, "", "-1 where the count falls while the joint turns to positive angles")
    zero_rad: float = quantity(0.0, "rad", "Joint angle by the drive's count while the arm hangs straight down")
    side_channel: str = quantity(
        "", "", "Only of a simulated device: where its loads are hung, as host:port; left out: a person is asked"
    )


def driver_values(settings: RealDriveSettings) -> dict[str, Any]:
    """What the driver's own settings take: all but the kind, and what the joint's scale takes."""
    return settings.model_dump(exclude=set(RealDriveSettings.model_fields))


def joint_scale(settings: RealDriveSettings, rig: Rig) -> JointScale:
    """The joint as a drive has to know it.

    Raises:
        ConfigurationError: the rig leaves out the encoder's counts or the gear ratio.
    """
    if rig.sensor.counts_per_turn is None or rig.gear.ratio is None:
        raise ConfigurationError(
            f"rig '{rig.name}': a real drive needs sensor.counts_per_turn and gear.ratio to turn counts into joint "
            "angles; add them to the rig"
        )
    return JointScale(
        counts_per_turn=rig.sensor.counts_per_turn,
        gear_ratio=rig.gear.ratio,
        motor_sign=settings.motor_sign,
        encoder_sign=settings.encoder_sign,
        zero_rad=settings.zero_rad,
    )


class CanDriveSettings(RealDriveSettings):
    """How a CAN bus of python-can is reached."""

    interface: str = quantity(
        ..., "", "Interface of python-can: socketcan (Linux), slcan (serial adapter), pcan, kvaser ...", min_length=1
    )
    channel: str = quantity(..., "", "can0, /dev/ttyACM0, PCAN_USBBUS1", min_length=1)
    bitrate: Bitrate = quantity(1_000_000, "bit/s", "Bit rate of the bus")
    tty_baudrate: int = quantity(
        115200, "bit/s", "Baud rate of the serial line of an slcan adapter; ignored on USB", ge=9600
    )
    adapter_start_s: float = quantity(0.0, "s", "What an slcan adapter needs after its port is opened", ge=0, le=10)
    options: dict[str, str | int | float | bool] = quantity(
        {}, "", "What else the interface takes, as python-can's documentation of it says"
    )


def can_values(settings: CanDriveSettings) -> Mapping[str, Any]:
    """What the driver's own settings take, the bus in one."""
    from drivers.can_bus.settings import BusSettings

    values = driver_values(settings)
    return values | {"bus": BusSettings(**{name: values.pop(name) for name in CanDriveSettings.__annotations__})}
