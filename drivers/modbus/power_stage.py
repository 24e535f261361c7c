"""The power stage in registers: what is written to switch and to drive it, and what its status word says. Pure."""

from drivers.contract import Mode, Status
from drivers.joint import JointScale
from drivers.modbus.register_map import RegisterMap, Words

Values = dict[str, float]  # by register name

_STATES = {"fault": Status.FAULT, "quick_stop": Status.QUICK_STOP, "enabled": Status.ENABLED}


class Demand:
    """Values to be written: control words, mode and demands."""

    def __init__(self, register_map: RegisterMap, joint: JointScale) -> None:
        self._map, self._joint = register_map, joint
        self._zero: Values = {
            register.name: 0.0 for mode, register in register_map.demand.items() if mode is not Mode.POSITION
        }
        self._kept: Values = {}

    def keep(self, mode: Mode) -> None:
        """The drive has taken a mode: it stays written, for a drive may refuse another one while the joint moves."""
        self._kept = _word_of(self._map.mode, mode.value)

    def motion(self, mode: Mode, value: float) -> Values:
        """What is written for a demand [duty, A or rad of the joint]; every other demand is zero."""
        raw = float(self._joint.counts(value)) if mode is Mode.POSITION else self._joint.motor_sign * value
        words = _word_of(self._map.control, mode.value) | _word_of(self._map.mode, mode.value)
        return self._zero | words | {self._map.demand[mode].name: raw}

    def rest(self, stopping: bool) -> Values:
        """What is written while nothing is demanded: off, or the quick stop where the drive has one."""
        control = self._map.control
        word = _word_of(control, "quick_stop") if stopping else {}
        return self._zero | self._kept | (word or _word_of(control, "off"))

    def clearing(self) -> Values | None:
        """What clears a fault; None where the drive has no word for it."""
        word = _word_of(self._map.control, "clear_fault")
        return self._zero | self._kept | word if word else None


def state_of(register_map: RegisterMap, values: Values, told: Status) -> Status:
    """The state."""
    if register_map.fault is not None and values[register_map.fault.name] != 0.0:
        return Status.FAULT
    if register_map.status is None:
        return told
    word = values[register_map.status.register.name]
    return next((state for name, state in _STATES.items() if register_map.status.holds(name, word)), Status.DISABLED)


def _word_of(words: Words | None, name: str) -> Values:
    """The value that says something, by its register's name; empty where the drive has no such word."""
    return {} if words is None or name not in words.words else {words.register.name: float(words.words[name])}
