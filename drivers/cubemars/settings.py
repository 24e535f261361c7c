"""What has to be known of a CubeMars actuator before it is opened."""

from typing import Literal

from drivers.can_bus.settings import CanSettings
from drivers.settings import quantity

Model = Literal[
    "", "AK10-9", "AK40-10", "AK45-10", "AK45-36", "AK60-6", "AK70-10", "AK80-6", "AK80-8", "AK80-9", "AK80-64"
]


class CubemarsSettings(CanSettings):
    """How to reach one actuator."""

    motor_id: int = quantity(1, "", "CAN id of the actuator", ge=1, le=0x7F)
    feedback_id: int | None = quantity(
        None, "", "Identifier of its answers; left out: motor_id; 0 with older firmware", ge=0, le=0x7FF
    )
    model: Model = quantity("", "", "Model on its plate, whose ranges its frames have")
    position_range_rad: float = quantity(
        0.0, "rad", "Range of another firmware, with the next two; 0: the model's", ge=0
    )
    speed_range_rad_s: float = quantity(0.0, "rad/s", "Range of another firmware; 0: the model's", ge=0)
    torque_range_n_m: float = quantity(0.0, "N m", "Range of another firmware; 0: the model's", ge=0)
    accept_no_watchdog: bool = quantity(
        False, "", "true: it is known that the motor goes on with the last torque where this computer falls silent"
    )
    is_simulated: bool = quantity(False, "", "true of a simulated device: its frames have no place for that")
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"

    @property
    def answer_id(self) -> int:
        """Identifier of its answers."""
        return self.motor_id if self.feedback_id is None else self.feedback_id
