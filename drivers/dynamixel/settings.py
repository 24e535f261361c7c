"""What has to be known of a Dynamixel before it is opened."""

from math import ceil
from typing import Literal

from drivers.dynamixel.control_table import WATCHDOG_STEP_S
from drivers.settings import Settings, quantity

_LONGEST_STEPS = 127

BaudRate = Literal[9600, 57600, 115200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000]


class DynamixelSettings(Settings):
    """How to reach one servo."""

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

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.port} id {self.servo_id}"

    @property
    def watchdog_steps(self) -> int:
        """The bus watchdog as it is set [20 ms]; not shorter than was asked for."""
        return min(max(1, ceil(self.watchdog_s / WATCHDOG_STEP_S - 1e-9)), _LONGEST_STEPS)

    @property
    def set_watchdog_s(self) -> float:
        """The same [s]."""
        return self.watchdog_steps * WATCHDOG_STEP_S
