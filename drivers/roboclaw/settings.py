"""What has to be known of a RoboClaw before it is opened."""

from math import ceil
from typing import Literal

from drivers.settings import Settings, quantity

WATCHDOG_STEP_S = 0.1  # command 14 counts in these

BaudRate = Literal[2400, 9600, 19200, 38400, 57600, 115200, 230400, 460800]


class RoboclawSettings(Settings):
    """How to reach one motor of one controller."""

    port: str = quantity(..., "", "Serial port, such as /dev/ttyACM0", min_length=1)
    baud_rate: BaudRate = quantity(115200, "", "Baud rate of the line; ignored on USB")
    address: int = quantity(0x80, "", "Address of the controller", ge=0x80, le=0x87)
    motor: Literal[1, 2] = quantity(1, "", "Which of its two motors")
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops the motor, in steps of 0.1 s", ge=0.1, le=2.0)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.005, le=1.0)
    slow_every: int = quantity(
        4, "cycles", "Cycles between questions for status, supply voltage or temperature, in turn", ge=1, le=100
    )
    # the controller times its own speed, and filters it over a while that the manual does not state
    velocity: Literal["drive", "none"] = quantity(
        "drive",
        "",
        "'drive': its own, filtered speed (command 18); 'none': derived from the position, one question less",
    )
    # a magnitude takes the sign of the applied duty
    current: Literal["signed", "magnitude"] = quantity(
        "signed", "", "'magnitude' where it reports the current without the sign of the torque"
    )
    # in turn as the maker's own library asks; the manual calls packet serial buffered, and says no more
    questions: Literal["auto", "in turn", "together"] = quantity(
        "auto",
        "",
        "'together': a cycle's duty and questions in one write, which is quicker; 'auto': together where it answers "
        "them all when it is opened, otherwise in turn",
    )
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the controller; left out: the controller's own", gt=0, le=1000
    )

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.port} address {self.address:#x} M{self.motor}"

    @property
    def watchdog_steps(self) -> int:
        """The serial time-out as it is set [0.1 s]; not shorter than was asked for."""
        return max(1, ceil(self.watchdog_s / WATCHDOG_STEP_S - 1e-9))

    @property
    def set_watchdog_s(self) -> float:
        """The same [s]."""
        return self.watchdog_steps * WATCHDOG_STEP_S
