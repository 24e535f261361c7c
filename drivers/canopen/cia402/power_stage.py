"""Switching the power stage on and off, and clearing faults: the state machine of CiA 402, one SYNC at a time."""

import time
from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.heartbeat import NmtState
from drivers.canopen.cia301.object_access import ObjectRefusedError
from drivers.canopen.cia301.objects import CONTROLWORD, MODE, MODE_DISPLAY
from drivers.canopen.cia402.demand import Demand
from drivers.canopen.cia402.state_machine import (
    DISABLE_VOLTAGE,
    FAULT_RESET,
    State,
    state_of,
    status_of,
    towards_enabled,
)
from drivers.canopen.session import Session
from drivers.contract import Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, DriveFault, DriveStateError

_SWITCH_ON_S: Final = 1.0
_SWITCH_OFF_S: Final = 0.25
_RESET_S: Final = 0.5
_MODE_S: Final = 0.3
_PAUSE_S: Final = 0.001  # between SYNCs: a drive needs a moment for a transition


class PowerStage:
    """The power stage of a connected drive.

    Args:
        session: connected.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._device = session.settings.device

    @property
    def statusword(self) -> int:
        """As last received."""
        return self._session.cycle.values[0][0]

    @property
    def state(self) -> State:
        """As last received."""
        return state_of(self.statusword)

    def switch_on(self, mode: Mode) -> Demand:
        """Arm the watchdog, switch the mode, and power the stage with nothing demanded.

        Returns:
            The demand that goes on from there.

        Raises:
            DriveStateError: the drive has a fault, or does not switch on in time.
            DriveFault: it trips while it switches on.
            DriveConfigurationError: it does not take the mode.
            WatchdogError: its watchdog cannot be set.
        """
        session = self._session
        self._refresh()
        if status_of(self.state) is Status.FAULT:
            raise DriveStateError(
                self._device,
                f"cannot be enabled in state 'fault' ({session.fault_name()}); find the cause, then clear it",
            )
        if self.state in (State.ENABLED, State.QUICK_STOP):
            self.switch_off()
        session.emergency = None
        session.watchdog.arm()
        self._select(session.found.modes[mode])
        demand = Demand(self._device, session.found, session.data, mode, self._position_counts)

        def step() -> bool:
            # a drive counts from the first heartbeat that it hears: it has heard some before the power comes
            session.heartbeat.hurry()
            session.keep_alive()
            payload = demand.at_rest(towards_enabled(self.state), self._position_counts)
            answered = session.cycle.run(demand.pdo.cob_id, payload)
            if status_of(self.state) is Status.FAULT:
                raise DriveFault(self._device, f"tripped while it was enabled: {session.fault_name()}; find the cause")
            return answered and self.state is State.ENABLED

        if not _repeat(step, _SWITCH_ON_S):
            raise DriveStateError(
                self._device,
                f"state is '{self.state.value}' {_SWITCH_ON_S:g} s after enabling began; '{State.ENABLED.value}' is "
                "wanted. Check supply and enable input (safe torque off)",
            )
        return demand

    def switch_off(self) -> None:
        """Take the power away, and see that it is gone. The host's heartbeat is not sent meanwhile.

        Raises:
            DriveConnectionError: the drive does not confirm it. Its watchdog stops it.
        """
        session = self._session
        try:
            confirmed = _repeat(self._off_once, _SWITCH_OFF_S)
            if not confirmed:
                session.access.write(CONTROLWORD, DISABLE_VOLTAGE)  # another way, should SYNC or PDOs be at fault
        except DriveConnectionError as error:
            raise DriveConnectionError(
                self._device,
                f"power-off is not confirmed ({error}); its watchdog stops it {session.settings.watchdog_s:g} s after "
                "the last heartbeat",
            ) from error
        if session.watchdog.armed:
            with suppress(DriveError):
                session.watchdog.disarm()

    def clear_fault(self) -> None:
        """Reset a fault by the rising edge of bit 7, and stop at SWITCH ON DISABLED.

        Raises:
            DriveFault: the fault is still there.
        """
        session = self._session
        if session.watchdog.armed:
            session.watchdog.disarm()  # nobody has sent heartbeats lately: that alone would be the next fault
        self._refresh()
        if status_of(self.state) is not Status.FAULT:
            return
        name = session.fault_name()
        _repeat(lambda: self._send(DISABLE_VOLTAGE) and self.state is State.FAULT, _RESET_S)
        self._send(FAULT_RESET)
        if not _repeat(lambda: self._send(DISABLE_VOLTAGE) and self.state is State.SWITCH_ON_DISABLED, _RESET_S):
            raise DriveFault(self._device, f"cannot be cleared: {name}; remove the cause, then clear it")
        session.emergency = None

    def forgive_lost_host(self) -> None:
        """Clear the fault that says only that the last host went away: this one is here, and the power is off."""
        if self.state is State.FAULT and self._session.lost_its_host():
            self.clear_fault()

    @property
    def _position_counts(self) -> int:
        return self._session.cycle.values[1][0]

    def _refresh(self) -> None:
        """Hear of the state now; long may have passed."""
        session = self._session
        session.link.drain()
        if session.monitor.state is not NmtState.OPERATIONAL:
            session.start()
        if not _repeat(lambda: self._send(DISABLE_VOLTAGE), session.settings.answer_s):
            raise DriveConnectionError(self._device, "does not answer SYNC; check the cable, then open it again")

    def _send(self, controlword: int) -> bool:
        data = self._session.data
        return self._session.cycle.run(data.torque.cob_id, data.nothing(controlword))

    def _off_once(self) -> bool:
        answered = self._send(DISABLE_VOLTAGE)
        return answered and self.state not in (State.ENABLED, State.QUICK_STOP, State.FAULT_REACTION)

    def _select(self, code: int) -> None:
        session, problem = self._session, ""

        def shown() -> bool:
            session.keep_alive()
            return session.access.read(MODE_DISPLAY) == code

        try:
            session.access.write(MODE, code)
            if _repeat(shown, _MODE_S):
                return
            problem = f"{MODE_DISPLAY} stays {session.access.read(MODE_DISPLAY)}"
        except ObjectRefusedError as refusal:
            problem = str(refusal)
        raise DriveConfigurationError(
            self._device, f"mode {code} is refused: {problem}; {code} is wanted. Does the drive's own tool allow it?"
        )


def _repeat(step: Callable[[], bool], timeout_s: float) -> bool:
    """Repeat a step until it succeeds; tell whether it has, in time."""
    deadline_s = perf_counter() + timeout_s
    while not step():
        if perf_counter() > deadline_s:
            return False
        time.sleep(_PAUSE_S)
    return True
