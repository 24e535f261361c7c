"""The state machine of CiA 402 (part 2, 8.4): states from the statusword, controlwords towards a goal. Pure."""

from enum import Enum
from typing import Final

from drivers.contract import Status


class State(Enum):
    """State of the power drive system."""

    NOT_READY = "not ready to switch on"
    SWITCH_ON_DISABLED = "switch on disabled"
    READY = "ready to switch on"
    SWITCHED_ON = "switched on"
    ENABLED = "operation enabled"
    QUICK_STOP = "quick stop active"
    FAULT_REACTION = "fault reaction active"
    FAULT = "fault"
    UNKNOWN = "unknown"  # a pattern that CiA 402 does not define


_PATTERNS: Final = (
    (0x4F, 0x00, State.NOT_READY),
    (0x4F, 0x40, State.SWITCH_ON_DISABLED),
    (0x6F, 0x21, State.READY),
    (0x6F, 0x23, State.SWITCHED_ON),
    (0x6F, 0x27, State.ENABLED),
    (0x6F, 0x07, State.QUICK_STOP),
    (0x4F, 0x0F, State.FAULT_REACTION),
    (0x4F, 0x08, State.FAULT),
)


def _decode(statusword: int) -> State:
    return next((state for mask, value, state in _PATTERNS if statusword & mask == value), State.UNKNOWN)


_STATES: Final = tuple(_decode(word) for word in range(0x80))  # looked up every cycle

_STATUS: Final = {
    State.ENABLED: Status.ENABLED,
    State.QUICK_STOP: Status.QUICK_STOP,
    State.FAULT_REACTION: Status.FAULT,
    State.FAULT: Status.FAULT,
}

# commands (CiA 402-2, controlword)
SHUTDOWN: Final = 0x06
SWITCH_ON: Final = 0x07
ENABLE_OPERATION: Final = 0x0F
QUICK_STOP: Final = 0x02
DISABLE_VOLTAGE: Final = 0x00
FAULT_RESET: Final = 0x80

_TOWARDS_ENABLED: Final = {
    State.SWITCH_ON_DISABLED: SHUTDOWN,
    State.READY: SWITCH_ON,
    State.SWITCHED_ON: ENABLE_OPERATION,
    State.ENABLED: ENABLE_OPERATION,
}


def state_of(statusword: int) -> State:
    """State that a statusword tells."""
    return _STATES[statusword & 0x7F]


def status_of(state: State) -> Status:
    """State of the power stage, as the drive contract names it."""
    return _STATUS.get(state, Status.DISABLED)


def towards_enabled(state: State) -> int:
    """Next controlword on the way to OPERATION ENABLED. From a fault there is no way: it is reset on purpose only."""
    return _TOWARDS_ENABLED.get(state, DISABLE_VOLTAGE)


def towards_standstill(state: State) -> int:
    """Controlword of a quick stop, for as long as the drive brakes; then power off."""
    return QUICK_STOP if state in (State.ENABLED, State.QUICK_STOP) else DISABLE_VOLTAGE
