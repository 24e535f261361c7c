"""The hand-shake of a profile position target (CiA 402-2, 10.3): new set-point, acknowledge. Pure."""

from drivers.canopen.cia402.state_machine import ENABLE_OPERATION

_NEW_SET_POINT = 0x10
_CHANGE_IMMEDIATELY = 0x20
_ACKNOWLEDGED = 0x1000  # statusword bit 12


class SetPointHandshake:
    """Gives each target to the drive once.

    A target stays as it is until the drive has acknowledged it; then bit 4 has to fall before the next one counts.
    """

    def __init__(self, target: int) -> None:
        self._target = target
        self._offered = False

    def step(self, wanted: int, statusword: int) -> tuple[int, int]:
        """Controlword and target of the next cycle."""
        acknowledged = bool(statusword & _ACKNOWLEDGED)
        if self._offered:
            self._offered = not acknowledged
        elif not acknowledged and wanted != self._target:
            self._target = wanted
            self._offered = True
        bits = _NEW_SET_POINT | _CHANGE_IMMEDIATELY if self._offered else 0
        return ENABLE_OPERATION | bits, self._target
