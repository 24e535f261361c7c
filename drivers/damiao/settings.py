"""What has to be known of a Damiao actuator before it is opened."""

from typing import Literal

from drivers.can_bus.settings import CanSettings
from drivers.settings import quantity

Model = Literal[
    "", "DM3507", "DM4310", "DM4310P", "DM4340", "DM4340P", "DM6006", "DM8006", "DM8009", "DM10010L", "DM10010",
    "DMH3510", "DMG6215", "DMH6220",
]  # fmt: skip


class DamiaoSettings(CanSettings):
    """How to reach one actuator."""

    motor_id: int = quantity(1, "", "ESC_ID of the actuator", ge=1, le=0x7FE)
    feedback_id: int = quantity(0x11, "", "MST_ID of the actuator; of each another one", ge=0, le=0x7FE)
    model: Model = quantity("", "", "Model whose ranges it has to have; left out: those that it says are taken")
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops, set in its TIMEOUT register", ge=0.01, le=2)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"
