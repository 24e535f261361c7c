"""What has to be known of an ODrive before it is opened."""

from dataclasses import dataclass

from drivers.can_bus.settings import BusSettings


@dataclass(frozen=True, slots=True)
class OdriveSettings:
    """How to reach one axis.

    Attributes:
        bus: how the bus is reached.
        node_id: of the axis, 0 .. 62.
        watchdog_s: its watchdog as it is set with ODrive's own tool [s]; CANSimple has no message for it.
        watchdog_is_set_in_drive: True where somebody has set it so; it is not opened otherwise.
        answer_timeout_s: longest wait for the answers of a cycle [s].
        slow_every: cycles between two questions for supply voltage or temperature, in turn.
    """

    bus: BusSettings
    node_id: int = 0
    watchdog_s: float = 0.2
    watchdog_is_set_in_drive: bool = False
    answer_timeout_s: float = 0.05
    slow_every: int = 20

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} node {self.node_id}"
