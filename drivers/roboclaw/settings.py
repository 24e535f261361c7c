"""What has to be known of a RoboClaw before it is opened."""

from dataclasses import dataclass
from math import ceil
from typing import Literal

WATCHDOG_STEP_S = 0.1  # command 14 counts in these


@dataclass(frozen=True, slots=True)
class RoboclawSettings:
    """How to reach one motor of one controller.

    Attributes:
        port: serial port ("/dev/ttyACM0").
        baud_rate: of the line; ignored on USB.
        address: 0x80 .. 0x87.
        motor: 1 or 2.
        watchdog_s: silence after which the controller stops the motor [s], in steps of 0.1 s.
        answer_timeout_s: longest wait for one answer [s].
        slow_every: cycles between two questions for status, supply voltage or temperature, in turn.
        velocity: "drive": command 18, one question more per cycle, timed by the controller and filtered over a while
            that the manual does not state; "none": left to the control loop, which derives it from the position.
        current: "signed" where the controller reports the current with the sign of the motor's torque, "magnitude"
            where it does not; then it takes the sign of the applied duty.
        questions: "in turn": each after the answer to the one before, as the maker's own library does; "together": a
            cycle's duty and questions in one write. The manual calls packet serial buffered and says no more; a
            controller that does not answer them all is refused when it is opened, and with "auto" asked in turn.
        current_limit_a: highest motor current [A], set in the controller; None: the controller's own.
    """

    port: str
    baud_rate: int = 115200
    address: int = 0x80
    motor: int = 1
    watchdog_s: float = 0.2
    answer_timeout_s: float = 0.05
    slow_every: int = 4
    velocity: Literal["drive", "none"] = "drive"
    current: Literal["signed", "magnitude"] = "signed"
    questions: Literal["auto", "in turn", "together"] = "auto"
    current_limit_a: float | None = None

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
