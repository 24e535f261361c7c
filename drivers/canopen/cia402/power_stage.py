"""Switching the power stage on and off, and clearing faults: the state machine of CiA 402, one SYNC at a time."""

import time
from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.heartbeat import NmtState
from drivers.canopen.cia301.objects import CONTROLWORD, STATUSWORD
from drivers.canopen.cia402.demand import Demand
from drivers.canopen.cia402.homing import HomingDemand, set_up
from drivers.canopen.cia402.mode_switch import ModeSwitch
from drivers.canopen.cia402.state_machine import (
    DISABLE_VOLTAGE,
    FAULT_RESET,
    SWITCH_ON,
    State,
    state_of,
    status_of,
    towards_enabled,
)
from drivers.canopen.guard_trial import stops_when_silent
from drivers.canopen.session import Session
from drivers.contract import Mode, Status
from drivers.errors import DriveConnectionError, DriveError, DriveFault, DriveStateError, WatchdogError
from drivers.refusal import not_cleared

SWITCH_OFF_S: Final = 0.5
_HOLD_S: Final = 0.03  # of each level of the reset bit at first: a drive looks at it every 1 .. 20 ms
_LONGEST_HOLD_S: Final = 0.5
_LOOK_S: Final = 0.1  # that a drive has to take a controlword
_PAUSE_S: Final = 0.001  # between SYNCs: a drive needs a moment for a transition
_POWERED: Final = (State.ENABLED, State.QUICK_STOP, State.FAULT_REACTION)


class PowerStage:
    """The power stage of a connected drive."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._device = session.settings.device

    @property
    def state(self) -> State:
        """As last received."""
        return state_of(self._session.statusword)

    def switch_on(self, mode: Mode) -> Demand | HomingDemand:
        """Switch the mode, arm the watchdog, and power the stage with nothing demanded.

        A watchdog whose reaction the drive does not tell is tried now, before anything can move.

        Returns:
            The demand that goes on from there.

        Raises:
            DriveStateError: the drive has a fault, or does not switch on in time.
            DriveFault: it trips while it switches on.
            DriveConfigurationError: it does not take the mode.
            DriveConnectionError: another host is on the bus.
            WatchdogError: its watchdog cannot be set, or does not stop it.
        """
        session = self._session
        session.look_round()
        demand = self._power(mode)
        if not session.guard.is_told and not session.guard.tried:
            self._try_guard()
            demand = self._power(mode)
        return demand

    def stand_down(self, engage_s: float) -> None:
        """Leave operation enabled by the drive's own order: it stops, sets its brake, lets go. Then power off.

        Args:
            engage_s: time that its brake takes [s].

        Raises:
            DriveConnectionError: it does not confirm the power-off.
        """
        try:
            _repeat(self._disabled_once, engage_s + SWITCH_OFF_S)
        finally:
            self.switch_off()

    def switch_off(self) -> None:
        """Take the power away, and see that it is gone. The host gives no sign of life meanwhile.

        Raises:
            DriveConnectionError: the drive does not confirm it. Its watchdog stops it.
            DriveStateError: it did not obey, as one that brakes in a fault does not; it was reset.
        """
        session = self._session
        try:
            if not _repeat(self._off_once, SWITCH_OFF_S):
                self._force_off()
        except DriveConnectionError as error:
            raise DriveConnectionError(
                self._device,
                f"power-off is not confirmed ({error}); its watchdog stops it {session.settings.watchdog_s:g} s after "
                "the last sign of life of this host",
            ) from error
        if session.guard.armed:
            with suppress(DriveError):
                session.guard.disarm()
        session.speaking = session.data.idle

    def clear_fault(self) -> None:
        """Reset a fault by the rising edge of bit 7, held and repeated, and stop at SWITCH ON DISABLED.

        Raises:
            DriveFault: the fault is still there.
        """
        session = self._session
        if session.guard.armed:
            session.guard.disarm()  # nobody has given signs of life lately: that alone would be the next fault
        session.speaking = session.data.idle
        self._refresh()
        if status_of(self.state) is not Status.FAULT:
            return
        name, within_s = session.fault_name(), session.settings.fault_reset_s
        if not self._reset(within_s):
            brakes = " (the drive brakes still: its ramps may be slow, 0x6085 or 0x6084)"
            braking = brakes if self.state is State.FAULT_REACTION else ""
            raise not_cleared(self._device, f"{name}, after {within_s:g} s{braking}")
        session.emergency = None

    def forgive_lost_host(self) -> None:
        """Clear the fault that says only that the last host went away: this one is here, and the power is off."""
        if status_of(self.state) is Status.FAULT and self._session.lost_its_host():
            self.clear_fault()

    def _power(self, mode: Mode) -> Demand | HomingDemand:
        session = self._session
        self._refresh()
        if status_of(self.state) is Status.FAULT:
            raise DriveStateError(
                self._device,
                f"cannot be enabled in state '{self.state.value}' ({session.fault_name()}); find the cause, then "
                "clear it",
            )
        if seen := session.torque_off():
            raise DriveStateError(self._device, f"cannot be enabled: safe torque off is active ({seen})")
        if self.state in (State.ENABLED, State.QUICK_STOP):
            self.switch_off()
        session.emergency = None
        demand = self._demand(mode)
        switch = ModeSwitch(session, demand.code)
        shown = switch.select()
        if not shown:
            switch.rest_every_target()
        session.speaking = demand.pdo
        session.guard.watch_demands((demand.pdo.number,))
        session.monitor.begin(perf_counter())
        session.guard.arm()
        self._enable(demand)
        if not shown:
            switch.await_shown(lambda: self._step(demand))
        return demand

    def _demand(self, mode: Mode) -> Demand | HomingDemand:
        session = self._session
        if mode is not Mode.HOME:
            return Demand(session.settings, session.found, session.data, mode, session.position_counts)
        assert session.settings.homing is not None, "checked when it was enabled"
        set_up(session.table, session.found.scale, session.settings.homing)
        return HomingDemand(session.data)

    def _enable(self, demand: Demand | HomingDemand) -> None:
        limit_s = self._session.settings.enable_s
        if not _repeat(lambda: self._step(demand) and self.state is State.ENABLED, limit_s):
            raise DriveStateError(
                self._device,
                f"state is '{self.state.value}' {limit_s:g} s after enabling began; '{State.ENABLED.value}' is wanted. "
                "Check supply, enable input (safe torque off) and brake; a drive that needs longer gets enable_s",
            )

    def _step(self, demand: Demand | HomingDemand) -> bool:
        """One cycle towards operation enabled, nothing demanded; tell whether it was answered."""
        session = self._session
        # a drive counts from the first sign of life that it hears: it has heard some before the power comes
        session.guard.hurry()
        session.keep_alive()
        payload = demand.at_rest(towards_enabled(self.state), session.position_counts)
        answered = session.cycle.run(demand.pdo.cob_id, payload)
        session.strangers.check()
        if status_of(self.state) is Status.FAULT:
            raise DriveFault(self._device, f"tripped while it was enabled: {session.fault_name()}; find the cause")
        return answered

    def _try_guard(self) -> None:
        session = self._session
        session.guard.tried = stops_when_silent(session)
        if not session.guard.tried:
            raise WatchdogError(
                self._device,
                f"its watchdog does not stop it: {session.guard.words}. It was left enabled with no demand and without "
                "a sign of this host for longer than that, and is enabled still. It must not move: it would go on when "
                "this host dies. Set a watchdog with the drive's own tool",
            )
        self.clear_fault()

    def _reset(self, limit_s: float) -> bool:
        """Raise bit 7 again and again, for longer each time; tell whether the fault is gone."""
        deadline_s = perf_counter() + limit_s
        hold_s = _HOLD_S
        while perf_counter() < deadline_s:
            self._hold(DISABLE_VOLTAGE, hold_s)
            if self._hold(FAULT_RESET, hold_s):
                left_s = max(deadline_s - perf_counter(), _LONGEST_HOLD_S)
                return _repeat(lambda: self._answers(DISABLE_VOLTAGE) and not self._faulty(), left_s)
            hold_s = min(2.0 * hold_s, _LONGEST_HOLD_S)
        return False

    def _hold(self, controlword: int, duration_s: float) -> bool:
        """Send a controlword until the fault is gone; tell whether it went."""
        return _repeat(lambda: self._answers(controlword) and not self._faulty(), duration_s)

    def _faulty(self) -> bool:
        return status_of(self.state) is Status.FAULT

    def _refresh(self) -> None:
        """Hear of the state now; long may have passed."""
        session = self._session
        session.link.drain()
        if session.monitor.state is not NmtState.OPERATIONAL or not self._answers(DISABLE_VOLTAGE):
            session.start()  # one that sends no heartbeats does not tell that it has left OPERATIONAL
        if not _repeat(lambda: self._answers(DISABLE_VOLTAGE), session.settings.answer_s):
            raise DriveConnectionError(self._device, "does not answer SYNC; check the cable, then open it again")

    def _force_off(self) -> None:
        """Another way, should SYNC or PDOs be at fault; and where the drive brakes on in a fault, its reset."""
        access = self._session.access
        access.write(CONTROLWORD, DISABLE_VOLTAGE)
        if not _repeat(lambda: state_of(access.read(STATUSWORD)) not in _POWERED, _LOOK_S):
            self._session.reset()
            raise DriveStateError(
                self._device, f"state '{self.state.value}' did not end on power-off; the drive was reset (NMT)"
            )

    def _answers(self, controlword: int) -> bool:
        return self._session.idle(controlword)

    def _disabled_once(self) -> bool:
        self._session.keep_alive()
        return self._answers(SWITCH_ON) and self.state is not State.ENABLED

    def _off_once(self) -> bool:
        return self._answers(DISABLE_VOLTAGE) and self.state not in _POWERED


def _repeat(step: Callable[[], bool], timeout_s: float) -> bool:
    """Repeat a step until it succeeds; tell whether it has, in time."""
    deadline_s = perf_counter() + timeout_s
    while not step():
        if perf_counter() > deadline_s:
            return False
        time.sleep(_PAUSE_S)
    return True
