"""The state of the power stage: what the drive's status word says, or what was last told where it has none."""

from drivers.contract import Status
from drivers.modbus.register_map import RegisterMap, Words

_STATES = {"fault": Status.FAULT, "quick_stop": Status.QUICK_STOP, "enabled": Status.ENABLED}


def state_of(register_map: RegisterMap, values: dict[str, float], told: Status) -> Status:
    """The state.

    Args:
        register_map: of the drive.
        values: as read, by register name.
        told: the state that the drive was last told to be in.
    """
    if register_map.fault is not None and values[register_map.fault.name] != 0.0:
        return Status.FAULT
    if register_map.status is None:
        return told
    word = values[register_map.status.register.name]
    return next((state for name, state in _STATES.items() if register_map.status.holds(name, word)), Status.DISABLED)


def word_of(words: Words | None, name: str) -> dict[str, float]:
    """The value that says something, by its register's name; empty where the drive has no such word."""
    return {} if words is None or name not in words.words else {words.register.name: float(words.words[name])}
