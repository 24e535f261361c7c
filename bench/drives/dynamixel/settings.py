"""Settings of a Dynamixel on a serial bus."""

from typing import Literal

from bench.config.drives.real import RealDriveSettings
from bench.config.quantities import quantity

BaudRate = Literal[9600, 57600, 115200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000]


class DynamixelDriveSettings(RealDriveSettings):
    """One Dynamixel X servo, protocol 2.0."""

    kind: Literal["dynamixel"]
    port: str = quantity(..., "", "Serial port, such as /dev/ttyUSB0", min_length=1)
    baud_rate: BaudRate = quantity(57600, "", "Baud rate of the line")
    servo_id: int = quantity(1, "", "Id of the servo", ge=0, le=252)
    watchdog_s: float = quantity(
        0.2, "s", "Silence on the bus after which it stops the motor, in steps of 0.02 s", ge=0.02, le=2.0
    )
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the servo; left out: the servo's own", gt=0, le=10
    )
