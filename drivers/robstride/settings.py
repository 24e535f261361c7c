"""What has to be known of a RobStride actuator before it is opened."""

from dataclasses import dataclass

from drivers.can_bus.settings import BusSettings


@dataclass(frozen=True, slots=True)
class RobstrideSettings:
    """How to reach one actuator.

    Attributes:
        bus: how the bus is reached.
        motor_id: its CAN id.
        model: whose ranges its frames have; "": they are written.
        position_range_rad, speed_range_rad_s, torque_range_n_m: those of another firmware; 0: the model's.
        watchdog_s: silence after which it stops [s], set in its parameter canTimeout.
        answer_timeout_s: longest wait for one answer [s].
    """

    bus: BusSettings
    motor_id: int = 127
    model: str = ""
    position_range_rad: float = 0.0
    speed_range_rad_s: float = 0.0
    torque_range_n_m: float = 0.0
    watchdog_s: float = 0.2
    answer_timeout_s: float = 0.05

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"
