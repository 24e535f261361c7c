"""What has to be known of a Damiao actuator before it is opened."""

from dataclasses import dataclass

from drivers.can_bus.settings import BusSettings


@dataclass(frozen=True, slots=True)
class DamiaoSettings:
    """How to reach one actuator.

    Attributes:
        bus: how the bus is reached.
        motor_id: ESC_ID, to which it listens.
        feedback_id: MST_ID, with which it answers; of each actuator another one.
        model: whose ranges it has to have; "": those that it says are taken.
        watchdog_s: silence after which it stops [s], set in its TIMEOUT register.
        answer_timeout_s: longest wait for one answer [s].
    """

    bus: BusSettings
    motor_id: int = 1
    feedback_id: int = 0x11
    model: str = ""
    watchdog_s: float = 0.2
    answer_timeout_s: float = 0.05

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"
