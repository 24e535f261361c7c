"""A CANopen drive with the CiA 402 profile, as the drive contract wants it."""

from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.bus_load import cycle_s
from drivers.canopen.demand import Demand
from drivers.canopen.description import describe
from drivers.canopen.heartbeat import NmtState
from drivers.canopen.link import CanLink
from drivers.canopen.power_stage import PowerStage
from drivers.canopen.session import Session
from drivers.canopen.settings import CanopenSettings
from drivers.canopen.state_machine import State, status_of, towards_standstill
from drivers.canopen.sync_cycle import CycleCounts
from drivers.contract import Command, Description, Mode, Sample, Status
from drivers.demand import check_mode
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, DriveFault, DriveStateError
from drivers.joint import JointScale

_WATCHDOG_PERIODS: Final = 2  # cycles that the watchdog has to outlast


class CanopenDrive:
    """One drive on a CAN bus. The caller's thread owns the bus; there is no other.

    Args:
        settings: bus and drive.
        joint: what is on it.
    """

    def __init__(self, settings: CanopenSettings, joint: JointScale) -> None:
        self._joint = joint
        self._settings = settings
        self._device = settings.device
        self._link: CanLink | None = None
        self._session: Session | None = None
        self._power: PowerStage | None = None
        self._demand: Demand | None = None
        self._mode = Mode.OFF
        self._stopping = False

    @property
    def counts(self) -> CycleCounts:
        """What became of the cycles since opening.

        Raises:
            DriveStateError: it is not open.
        """
        return self._opened("counts")[0].cycle.counts

    @property
    def garbled(self) -> int:
        """Frames since opening that could not be read, or were not what their COB-ID promises."""
        return self._link.garbled if self._link is not None else 0

    def describe(self) -> Description:
        """Identity and capabilities. Complete once open."""
        return describe(self._settings, self._session)

    def open(self, period_s: float) -> None:
        """Connect: identity, watchdog, limits, PDOs, OPERATIONAL. The power stage stays off.

        Raises:
            DriveConnectionError: the bus is not there, or nobody answers at the node ID.
            DriveConfigurationError: what answers is not the drive that was configured, or the period is too short.
            WatchdogError: the watchdog cannot be set.
        """
        self.close()
        watchdog_s = self._settings.watchdog_s
        if not 0.0 < period_s * _WATCHDOG_PERIODS <= watchdog_s:
            raise DriveConfigurationError(
                self._device,
                f"control period {period_s:g} s: more than 0 and at most {watchdog_s / _WATCHDOG_PERIODS:g} s (half "
                "the watchdog) is wanted; change the period or watchdog_s",
            )
        self._link = CanLink(self._settings.bus, self._device)
        try:
            self._link.open()
            self._session = Session(self._link, self._settings, self._joint, period_s)
            self._power = PowerStage(self._session)
            self._check_bus_load(self._session, period_s)
            self._forgive_lost_host()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Power off and disconnect. Safe to call twice, and from any state."""
        link, session, power = self._link, self._session, self._power
        self._link = self._session = self._power = self._demand = None
        self._mode, self._stopping = Mode.OFF, False
        try:
            if session is not None and power is not None:
                # where the power-off fails nobody must tell the drive's watchdog to look away
                with suppress(DriveError):
                    power.switch_off()
                    session.leave()
        finally:
            if link is not None:
                link.close()

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand; in POSITION that is the present position.

        Raises:
            DriveConfigurationError: the drive does not have the mode, or refuses it.
            DriveStateError: it is not open, has a fault, or does not switch on.
            WatchdogError: its watchdog cannot be set.
        """
        session, power = self._opened("enable")
        check_mode(self._device, mode, frozenset(session.found.modes))
        self._mode, self._stopping = Mode.OFF, False
        try:
            self._demand = power.switch_on(mode)
        except BaseException:
            with suppress(DriveError):
                power.switch_off()
            raise
        self._mode = mode

    def disable(self) -> None:
        """Power off. Safe to call in any state of an open drive.

        Raises:
            DriveConnectionError: the drive does not confirm it; its watchdog stops it.
        """
        _, power = self._opened("disable")
        self._mode, self._stopping = Mode.OFF, False
        power.switch_off()

    def quick_stop(self) -> None:
        """Brake on the drive's quick-stop ramp during the exchanges that follow; the drive then powers off."""
        self._opened("quick_stop")
        self._mode, self._stopping = Mode.OFF, True
        self._exchange_off()

    def clear_fault(self) -> None:
        """Reset a fault. The drive is left disabled.

        Raises:
            DriveFault: the cause is still there.
        """
        _, power = self._opened("clear_fault")
        self._mode, self._stopping = Mode.OFF, False
        power.clear_fault()

    def exchange(self, command: Command) -> Sample:
        """Send one command with a SYNC, and return what the drive measured at that SYNC.

        A cycle that is not answered in time gives the previous measurement, older: see `age_s` and `number`.

        Raises:
            DriveFault: the drive has switched itself off, or its watchdog has.
            DriveStateError: motion was commanded in a mode that is not enabled.
            DriveConfigurationError: the command is not finite, or does not fit; nothing was sent.
            DriveConnectionError: the drive does not answer, its heartbeat is gone, or it has restarted.
        """
        if command.mode is Mode.OFF:
            return self._exchange_off()
        session, power = self._opened("exchange")
        if command.mode is not self._mode or self._demand is None:
            raise self._not_enabled(power, command.mode)
        payload = self._demand.payload(command, power.statusword)
        self._run(session, self._demand.pdo.cob_id, payload)
        if power.state is not State.ENABLED:
            raise self._switched_off(session, power)
        return self._sample(session, power)

    def _exchange_off(self) -> Sample:
        session, power = self._opened("exchange")
        self._mode = Mode.OFF
        word = towards_standstill(power.state) if self._stopping else 0
        answered = self._run(session, session.data.torque.cob_id, session.data.nothing(word))
        sample = self._sample(session, power)
        if answered and sample.status is not Status.QUICK_STOP:
            self._stopping = self._stopping and power.state is State.ENABLED
            if session.watchdog.armed and sample.status is Status.DISABLED:
                session.watchdog.disarm()
        return sample

    def _run(self, session: Session, cob_id: int, payload: bytes) -> bool:
        """One cycle, with all that has to be looked after in it."""
        session.keep_alive()
        answered = session.cycle.run(cob_id, payload)
        now_s, monitor = perf_counter(), session.monitor
        session.ask_slow(now_s)
        if not answered:
            self._check_silence(session)
        silence_s = monitor.silence_s(now_s)
        if monitor.restarted or silence_s > monitor.timeout_s:
            what = "has restarted" if monitor.restarted else f"has sent no heartbeat for {silence_s:.3g} s"
            raise DriveConnectionError(self._device, f"{what}; check supply and cable, then open it again")
        return answered

    def _check_silence(self, session: Session) -> None:
        silence_s, allowed_s = session.cycle.silence_s, self._settings.answer_s
        if silence_s <= allowed_s:
            return
        state = session.monitor.state
        if state is not None and state is not NmtState.OPERATIONAL:
            raise DriveFault(
                self._device, f"has left OPERATIONAL, it is {state.name}: {session.fault_name()}; clear the fault"
            )
        raise DriveConnectionError(
            self._device,
            f"no answer to SYNC for {silence_s:.3g} s; at most {allowed_s:g} s is allowed. Check cable and supply, "
            "then open it again",
        )

    def _sample(self, session: Session, power: PowerStage) -> Sample:
        cycle = session.cycle
        state, motion = cycle.values
        return session.measurement.sample(
            state, motion, session.poll.readings, status_of(power.state), cycle.sync_s, perf_counter(), cycle.number
        )

    def _opened(self, call: str) -> tuple[Session, PowerStage]:
        if self._session is None or self._power is None:
            raise DriveStateError(self._device, f"{call} before open; call open(period_s) first")
        return self._session, self._power

    def _not_enabled(self, power: PowerStage, mode: Mode) -> DriveError:
        if status_of(power.state) is Status.FAULT and self._session is not None:
            return self._switched_off(self._session, power)
        return DriveStateError(
            self._device, f"a {mode.value} command in state '{power.state.value}'; enable {mode.value} mode first"
        )

    def _switched_off(self, session: Session, power: PowerStage) -> DriveFault:
        named = status_of(power.state) is Status.FAULT or session.emergency is not None
        why = session.fault_name() if named else "no error is reported. Check the enable input (safe torque off)"
        return DriveFault(
            self._device, f"switched itself off, state '{power.state.value}': {why}; then clear the fault"
        )

    def _check_bus_load(self, session: Session, period_s: float) -> None:
        fastest_s = cycle_s(session.data.sizes, self._settings.bus.bitrate)
        if period_s < fastest_s:
            raise DriveConfigurationError(
                self._device,
                f"control period {period_s:g} s: the frames of a cycle take {fastest_s:.3g} s on this bus; "
                "at least that is wanted; change the period or the bit rate",
            )

    def _forgive_lost_host(self) -> None:
        """Clear the fault that says only that the last host went away: this one is here, and the power is off."""
        session, power = self._opened("open")
        if power.state is State.FAULT and session.lost_its_host():
            power.clear_fault()
