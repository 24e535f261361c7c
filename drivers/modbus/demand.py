"""What a cycle writes: control words, mode and demands, by the names of the map's registers."""

from drivers.contract import Mode
from drivers.joint import JointScale
from drivers.modbus.power_stage import word_of
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.requests import Values


class Demand:
    """Values to be written.

    Args:
        register_map: of the drive.
        joint: scales and signs.
    """

    def __init__(self, register_map: RegisterMap, joint: JointScale) -> None:
        self._map, self._joint = register_map, joint
        self._zero: Values = {
            register.name: 0.0 for mode, register in register_map.demand.items() if mode is not Mode.POSITION
        }
        self._kept: Values = {}

    def keep(self, mode: Mode) -> None:
        """The drive has taken a mode: it stays written, for a drive may refuse another one while the joint moves."""
        self._kept = word_of(self._map.mode, mode.value)

    def motion(self, mode: Mode, value: float) -> Values:
        """What is written for a demand [duty, A or rad of the joint]; every other demand is zero."""
        raw = float(self._joint.counts(value)) if mode is Mode.POSITION else self._joint.motor_sign * value
        words = word_of(self._map.control, mode.value) | word_of(self._map.mode, mode.value)
        return self._zero | words | {self._map.demand[mode].name: raw}

    def rest(self, stopping: bool) -> Values:
        """What is written while nothing is demanded: off, or the quick stop where the drive has one."""
        control = self._map.control
        word = word_of(control, "quick_stop") if stopping else {}
        return self._zero | self._kept | (word or word_of(control, "off"))

    def clearing(self) -> Values | None:
        """What clears a fault; None where the drive has no word for it."""
        word = word_of(self._map.control, "clear_fault")
        return self._zero | self._kept | word if word else None
