"""What has to be known of a Feetech servo before it is opened."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FeetechSettings:
    """How to reach one servo.

    Attributes:
        port: serial port ("/dev/ttyACM0").
        baud_rate: of the line.
        servo_id: 0 .. 253.
        accept_no_watchdog: True where the user knows that the servo goes on with the last demand when the host falls
            silent; it is not opened otherwise.
        torque_limit: highest share of its torque that the servo gives, 0 .. 1, set in its memory until power-off.
        answer_timeout_s: longest wait for one answer [s].
    """

    port: str
    baud_rate: int = 1_000_000
    servo_id: int = 1
    accept_no_watchdog: bool = False
    torque_limit: float = 1.0
    answer_timeout_s: float = 0.05

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.port} id {self.servo_id}"
