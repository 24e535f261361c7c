"""What has to be known of an ODrive before it is opened."""

from drivers.can_bus.settings import CanSettings
from drivers.settings import quantity


class OdriveSettings(CanSettings):
    """How to reach one axis."""

    node_id: int = quantity(0, "", "Node ID of the axis", ge=0, le=62)
    watchdog_s: float = quantity(
        0.2, "s", "Its watchdog, as it is set with odrivetool; CANSimple has no message for it", ge=0.02, le=2.0
    )
    watchdog_is_set_in_drive: bool = quantity(
        False, "", "true: axis0.config.enable_watchdog and watchdog_timeout are set so"
    )
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for the answers of a cycle", ge=0.002, le=1.0)
    slow_every: int = quantity(
        20, "cycles", "Cycles between two questions for supply voltage or temperature, in turn", ge=1, le=1000
    )

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.bus} node {self.node_id}"
