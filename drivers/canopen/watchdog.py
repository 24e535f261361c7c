"""The drive's own watchdog: it consumes the host's heartbeat, and stops when that fails to come."""

from typing import Final

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import (
    BEHAVIOUR_ON_COMMUNICATION_ERROR,
    CONNECTION_LOSS_OPTION,
    CONSUMER_HEARTBEAT,
    PRODUCER_HEARTBEAT,
    QUICK_STOP_OPTION,
    DriveObject,
)
from drivers.canopen.settings import CanopenSettings
from drivers.errors import WatchdogError

_QUICK_STOP_ON_LOSS: Final = 3  # 0x6007: quick stop
_QUICK_RAMP_THEN_OFF: Final = 2  # 0x605A: slow down on the quick-stop ramp, then power off
_STAY_OPERATIONAL: Final = 1  # 0x1029:01: keep sending TPDOs, so that the fault is heard of


class Watchdog:
    """Sets the watchdog, and reads it back.

    It watches only while the power stage is to be on: with the power off nothing can move, and nobody has to call.

    Args:
        access: to the drive.
        settings: its time-out, and the host's node ID.
    """

    def __init__(self, access: ObjectAccess, settings: CanopenSettings) -> None:
        self._access = access
        self._settings = settings
        self.armed = False

    def prepare(self) -> None:
        """Set what the drive does when it triggers, and try it: on, read back, off again.

        Raises:
            WatchdogError: an object cannot be set, or reads back otherwise.
        """
        self._set(CONNECTION_LOSS_OPTION, _QUICK_STOP_ON_LOSS)
        self._set(QUICK_STOP_OPTION, _QUICK_RAMP_THEN_OFF)
        self._set(PRODUCER_HEARTBEAT, heartbeat_ms(self._settings))
        if self._access.read_if_present(BEHAVIOUR_ON_COMMUNICATION_ERROR) is not None:
            self._set(BEHAVIOUR_ON_COMMUNICATION_ERROR, _STAY_OPERATIONAL)
        self.arm()
        self.disarm()

    def arm(self) -> None:
        """From the next heartbeat of the host on, the drive counts.

        Raises:
            WatchdogError: it does not.
        """
        time_ms = round(self._settings.watchdog_s * 1000)
        self.armed = True  # even where reading back fails: it may have been set
        self._set(CONSUMER_HEARTBEAT, self._settings.host_node_id << 16 | time_ms)

    def disarm(self) -> None:
        """The drive no longer counts. Only with the power off."""
        self._access.write(CONSUMER_HEARTBEAT, 0)
        self.armed = False

    def _set(self, item: DriveObject, value: int) -> None:
        try:
            self._access.write(item, value)
            found = self._access.read(item)
        except ObjectRefusedError as refusal:
            raise WatchdogError(
                self._settings.device, f"the watchdog cannot be set: {refusal}. Without it the drive must not move"
            ) from refusal
        if found != value:
            raise WatchdogError(
                self._settings.device,
                f"the watchdog cannot be set: {item} reads back as 0x{found & 0xFFFFFFFF:X}; 0x{value:X} is wanted. "
                "Without it the drive must not move; unlock the object in the drive's own tool",
            )


def heartbeat_ms(settings: CanopenSettings) -> int:
    """How often the drive sends its own heartbeat [ms]."""
    return max(round(settings.watchdog_s * 1000) // 2, 1)
