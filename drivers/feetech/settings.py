"""What has to be known of a Feetech servo before it is opened."""

from typing import Literal

from drivers.settings import Settings, quantity

BaudRate = Literal[38400, 57600, 76800, 115200, 128_000, 250_000, 500_000, 1_000_000]


class FeetechSettings(Settings):
    """How to reach one servo."""

    port: str = quantity(..., "", "Serial port, such as /dev/ttyACM0", min_length=1)
    baud_rate: BaudRate = quantity(1_000_000, "", "Baud rate of the line")
    servo_id: int = quantity(1, "", "Id of the servo", ge=0, le=253)
    accept_no_watchdog: bool = quantity(
        False, "", "true: it is known that the motor goes on with the last demand where this computer falls silent"
    )
    # in its memory until power-off
    torque_limit: float = quantity(1.0, "", "Highest share of its torque, set in the servo", gt=0, le=1)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.port} id {self.servo_id}"
