"""What has to be known of a CubeMars actuator before it is opened."""

from dataclasses import dataclass

from drivers.can_bus.settings import BusSettings


@dataclass(frozen=True, slots=True)
class CubemarsSettings:
    """How to reach one actuator.

    Attributes:
        bus: how the bus is reached.
        motor_id: to which it listens.
        feedback_id: identifier of its answers; None: `motor_id`, as of the present firmware.
        model: whose ranges its frames have; "": they are written.
        position_range_rad, speed_range_rad_s, torque_range_n_m: those of another firmware; 0: the model's.
        accept_no_watchdog: True where it is known that nothing stops it when the host falls silent.
        is_simulated: True of a simulated device: its frames have no place for that.
        answer_timeout_s: longest wait for one answer [s].
    """

    bus: BusSettings
    motor_id: int = 1
    feedback_id: int | None = None
    model: str = ""
    position_range_rad: float = 0.0
    speed_range_rad_s: float = 0.0
    torque_range_n_m: float = 0.0
    accept_no_watchdog: bool = False
    is_simulated: bool = False
    answer_timeout_s: float = 0.05

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} motor {self.motor_id}"

    @property
    def answer_id(self) -> int:
        """Identifier of its answers."""
        return self.motor_id if self.feedback_id is None else self.feedback_id
