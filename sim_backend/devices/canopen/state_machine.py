"""The CiA 402 state machine: controlword in, state out."""

from collections.abc import Callable
from enum import Enum
from typing import NamedTuple


class State(Enum):
    """States, by their bits in the statusword (bits 0 .. 3, 5, 6)."""

    NOT_READY = 0x00
    SWITCH_ON_DISABLED = 0x40
    READY_TO_SWITCH_ON = 0x21
    SWITCHED_ON = 0x23
    OPERATION_ENABLED = 0x27
    QUICK_STOP_ACTIVE = 0x07
    FAULT_REACTION_ACTIVE = 0x0F
    FAULT = 0x08


class Command(Enum):
    """What a controlword asks for: (mask, value) of its bits 0 .. 3."""

    ENABLE_OPERATION = (0x0F, 0x0F)
    SWITCH_ON = (0x0F, 0x07)
    SHUTDOWN = (0x07, 0x06)
    QUICK_STOP = (0x06, 0x02)
    DISABLE_VOLTAGE = (0x02, 0x00)


class Ramp(Enum):
    """Which deceleration stops the motor."""

    SLOW = 0x6084
    QUICK = 0x6085


class Ending(NamedTuple):
    """The motor is being stopped, and what comes then; None: it is held where it stopped."""

    ramp: Ramp
    then: State | None


FAULT_RESET = 0x80
QUICK_STOP_CODES = (0, 1, 2, 5, 6)  # options of 0x605A that this drive knows
_STANDS = (5, 6)  # of 0x605A: stay in quick stop active

_PLAIN: dict[tuple[State, Command], State] = {
    (State.SWITCH_ON_DISABLED, Command.SHUTDOWN): State.READY_TO_SWITCH_ON,
    (State.READY_TO_SWITCH_ON, Command.SWITCH_ON): State.SWITCHED_ON,
    (State.READY_TO_SWITCH_ON, Command.ENABLE_OPERATION): State.OPERATION_ENABLED,
    (State.READY_TO_SWITCH_ON, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,
    (State.READY_TO_SWITCH_ON, Command.QUICK_STOP): State.SWITCH_ON_DISABLED,
    (State.SWITCHED_ON, Command.ENABLE_OPERATION): State.OPERATION_ENABLED,
    (State.SWITCHED_ON, Command.SHUTDOWN): State.READY_TO_SWITCH_ON,
    (State.SWITCHED_ON, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,
    (State.SWITCHED_ON, Command.QUICK_STOP): State.SWITCH_ON_DISABLED,
    (State.OPERATION_ENABLED, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,
    (State.QUICK_STOP_ACTIVE, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,
}
_MOVING = (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE)


def command_of(controlword: int) -> Command | None:
    """Return what a controlword asks for."""
    return next((one for one in Command if controlword & one.value[0] == one.value[1]), None)


class StateMachine:
    """The power state of a drive.

    Attributes:
        ending: how the motor is being stopped; None while it is not.
    """

    def __init__(self, option: Callable[[int], int]) -> None:
        self._option = option
        self.reset()

    def reset(self) -> None:
        """Begin anew: switch on disabled."""
        self.state = State.SWITCH_ON_DISABLED
        self.ending: Ending | None = None
        self._controlword = 0

    def obey(self, controlword: int, fault_is_over: bool) -> bool:
        """Take a controlword; tell whether it has reset a fault."""
        rising = controlword & ~self._controlword
        self._controlword = controlword
        if self.state is State.FAULT:
            if rising & FAULT_RESET and fault_is_over:
                self.state = State.SWITCH_ON_DISABLED
                return True
            return False
        command = command_of(controlword)
        if command is not None:
            self._follow(command)
        return False

    def braked(self) -> None:
        """The motor stands."""
        if self.ending is not None and self.ending.then is not None:
            self._enter(self.ending.then)

    def fault(self) -> None:
        """Something is wrong: stop by 0x605E, then fault."""
        if self.state in (State.FAULT, State.FAULT_REACTION_ACTIVE):
            return
        code = self._option(0x605E)
        if self.state not in _MOVING or code == 0:
            self.fail()
        else:
            self.state = State.FAULT_REACTION_ACTIVE
            self.ending = Ending(Ramp.SLOW if code == 1 else Ramp.QUICK, State.FAULT)

    def fail(self) -> None:
        """Go to fault at once: the stage cannot brake any more."""
        self._enter(State.FAULT)

    def lose_torque(self) -> None:
        """The safe-torque-off circuit is open."""
        if self.state not in (State.FAULT, State.SWITCH_ON_DISABLED):
            self._enter(State.SWITCH_ON_DISABLED)

    def lose_master(self) -> None:
        """React by 0x6007: 0 nothing, 1 fault, 2 disable voltage, 3 quick stop."""
        match self._option(0x6007):
            case 1:
                self.fault()
            case 2:
                self._follow(Command.DISABLE_VOLTAGE)
            case 3:
                self._follow(Command.QUICK_STOP)

    def _follow(self, command: Command) -> None:
        if (self.state, command) in _PLAIN:
            self._enter(_PLAIN[self.state, command])
        elif self.state is State.OPERATION_ENABLED:
            self._leave(command)
        elif (self.state, command) == (State.QUICK_STOP_ACTIVE, Command.ENABLE_OPERATION) and self._stands():
            self._enter(State.OPERATION_ENABLED)

    def _leave(self, command: Command) -> None:
        """From operation enabled, by the option codes."""
        match command:
            case Command.ENABLE_OPERATION:
                self.ending = None
            case Command.SHUTDOWN:
                self._stop(self._option(0x605B), State.READY_TO_SWITCH_ON)
            case Command.SWITCH_ON:
                self._stop(self._option(0x605C), State.SWITCHED_ON)
            case Command.QUICK_STOP:
                self._quick_stop(self._option(0x605A))

    def _stop(self, code: int, then: State) -> None:
        if code == 0:
            self._enter(then)
        elif self.ending is None or self.ending.then is not then:
            self.ending = Ending(Ramp.SLOW, then)

    def _quick_stop(self, code: int) -> None:
        if code == 0:
            self._enter(State.SWITCH_ON_DISABLED)
            return
        self.state = State.QUICK_STOP_ACTIVE
        ramp = Ramp.SLOW if code in (1, 5) else Ramp.QUICK
        self.ending = Ending(ramp, None if self._stands() else State.SWITCH_ON_DISABLED)

    def _stands(self) -> bool:
        """Tell whether a quick stop leaves the motor held."""
        return self._option(0x605A) in _STANDS

    def _enter(self, state: State) -> None:
        self.state = state
        self.ending = None
