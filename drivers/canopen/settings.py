"""Settings of a CANopen drive, checked when they are made."""

from typing import Any

import can

from drivers.can_bus.settings import BITRATES, BusSettings
from drivers.canopen.cia402.bits import BrakeBit
from drivers.canopen.cia402.homing import DriveHoming
from drivers.canopen.parameters import CanopenParameters
from drivers.errors import DriveConfigurationError
from drivers.settings import quantity


class CanopenSettings(CanopenParameters):
    """One CANopen drive on its bus.

    Attributes:
        brake: the output that this host sets the holding brake by; None where it sets none.
        homing: how the drive homes by itself; None where it is not to.

    Raises:
        ValueError: a value that no drive has.
        DriveConfigurationError: values that cannot be meant together, or a bus that there cannot be.
    """

    bus: BusSettings
    brake: BrakeBit | None = None
    homing: DriveHoming | None = None
    torque_constant_n_m_a: float | None = quantity(
        None, "N m/A", "Of the motor: rated current, where the drive tells only its rated torque", gt=0
    )

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        bus, low, high = self.bus, self.position_min_rad, self.position_max_rad
        interfaces, bitrates = ", ".join(sorted(can.VALID_INTERFACES)), ", ".join(map(str, BITRATES))
        checks = (
            ("interface", bus.interface, f"one of {interfaces}", bus.interface in can.VALID_INTERFACES),
            ("channel", bus.channel, "a name", bool(bus.channel)),
            ("bitrate", bus.bitrate, f"one of {bitrates} [bit/s]", bus.bitrate in BITRATES),
            ("host_node_id", self.host_node_id, "1 .. 127, not the drive's", self.host_node_id != self.node_id),
            ("position_min_rad", low, "less than position_max_rad, and both or neither", _are_limits(low, high)),
            ("answer_s", self.answer_s, "more than 0 s and less than the watchdog", self.answer_s < self.watchdog_s),
        )
        for name, value, allowed, ok in checks:
            if not ok:
                raise DriveConfigurationError(
                    self.device, f"setting {name} = {value!r}: {allowed} is wanted; correct it in the configuration"
                )

    @property
    def device(self) -> str:
        """Name in messages."""
        return f"{self.bus} node {self.node_id}"


def _are_limits(low: float | None, high: float | None) -> bool:
    return (low is None) == (high is None) and (low is None or high is None or low < high)
