"""What `[drive]` says of a CAN bus, whatever the protocol on it."""

from typing import Any, Literal

from bench.config.drives.real import RealDriveSettings, driver_values
from bench.config.quantities import quantity

Bitrate = Literal[10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 1_000_000]


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


def can_values(settings: CanDriveSettings) -> dict[str, Any]:
    """What the driver's own settings take, the bus in one."""
    from drivers.can_bus.settings import BusSettings

    values = driver_values(settings)
    return values | {"bus": BusSettings(**{name: values.pop(name) for name in CanDriveSettings.__annotations__})}
