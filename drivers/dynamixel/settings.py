"""What has to be known of a Dynamixel before it is opened."""

from dataclasses import dataclass
from math import ceil

from drivers.dynamixel.control_table import WATCHDOG_STEP_S

_LONGEST_STEPS = 127


@dataclass(frozen=True, slots=True)
class DynamixelSettings:
    """How to reach one servo.

    Attributes:
        port: serial port ("/dev/ttyUSB0").
        baud_rate: of the line.
        servo_id: 0 .. 252.
        watchdog_s: silence after which the servo stops [s], in steps of 0.02 s.
        answer_timeout_s: longest wait for one answer [s].
        current_limit_a: highest motor current [A], set in the servo while its power is off; None: the servo's own.
    """

    port: str
    baud_rate: int = 57600
    servo_id: int = 1
    watchdog_s: float = 0.2
    answer_timeout_s: float = 0.05
    current_limit_a: float | None = None

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
