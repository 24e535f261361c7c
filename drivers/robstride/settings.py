"""What has to be known of a RobStride actuator before it is opened."""

from typing import Literal

from drivers.can_bus.settings import CanSettings
from drivers.settings import quantity

Model = Literal["", "RS00", "RS01", "RS02", "RS03", "RS04", "RS05", "RS06", "EL05"]


class RobstrideSettings(CanSettings):
    """How to reach one actuator."""

    motor_id: int = quantity(127, "", "CAN id of the actuator", ge=1, le=0x7F)
    model: Model = quantity("", "", "Model on its plate, whose ranges its frames have")
    position_range_rad: float = quantity(
        0.0, "rad", "Range of another firmware, with the next two; 0: the model's", ge=0
    )
    speed_range_rad_s: float = quantity(0.0, "rad/s", "Range of another firmware; 0: the model's", ge=0)
    torque_range_n_m: float = quantity(0.0, "N m", "Range of another firmware; 0: the model's", ge=0)
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops, set in its canTimeout", ge=0.01, le=2)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"
