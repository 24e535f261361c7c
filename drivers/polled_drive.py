"""The drive contract on a drive that answers questions: what such drivers do alike, whatever their protocol."""

from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
from typing import Generic, NamedTuple, Protocol, TypeVar

from drivers.contract import Command, Description, Drive, Inspection, Mode, Sample, Status
from drivers.errors import DriveError
from drivers.host_time import CycleTime, Lateness, measure_cycle
from drivers.refusal import check_demand, check_mode, not_cleared, not_enabled, not_open, switched_itself_off

_LIMITS = {Mode.DUTY: (1.0, ""), Mode.CURRENT: (1e3, "A"), Mode.TORQUE: (1e3, "N m"), Mode.POSITION: (1e3, "rad")}
_OFF = Command(Mode.OFF)


class Identity(NamedTuple):
    """What a drive says of itself; empty where it does not tell."""

    vendor: str
    product: str
    firmware: str = ""
    serial: str = ""
    simulated: bool = False


class PolledSession(Protocol):
    """A connected drive, in its protocol. Each call raises `DriveConnectionError` where it is not answered in time."""

    @property
    def state(self) -> Status:
        """Of the power stage, as the drive says; as it was told last where it does not say."""

    @property
    def told(self) -> Status:
        """What the drive was told last to be in."""

    def begin(self) -> None:
        """A call of the contract begins: from now on its questions share one time limit."""

    def switch_on(self, mode: Mode) -> None:
        """Power the stage with a demand that moves nothing. Raises `DriveStateError` where it does not switch on."""

    def switch_off(self) -> None:
        """Power off; a fault stays."""

    def begin_quick_stop(self) -> None:
        """Brake, where it is enabled; `rest` goes on with it, and powers off in the end."""

    def clear_fault(self) -> None:
        """Acknowledge a fault, and leave the power off; `state` says whether it is gone."""

    def move(self, mode: Mode, value: float) -> Sample:
        """One cycle with a demand [duty, A or rad of the joint]."""

    def rest(self) -> Sample:
        """One cycle without: the power goes off, or a quick stop goes on."""

    def inspect(self) -> Inspection:
        """State, fault and applied output, by questions alone."""

    def fault_text(self) -> str:
        """The fault in words."""

    def leave(self) -> None:
        """Power off where it answers, and give the port back. Never raises."""


SessionT = TypeVar("SessionT", bound=PolledSession)


class PolledDrive(Drive, Generic[SessionT]):
    """States, refusals and power-off, once for every protocol; what is sent is the session's.

    Args:
        device: name used in messages.
        modes: that the drive has.
        lateness: its watchdog by the host's clock.
        connect: makes the session; the power is off then, the watchdog set and read back.
        describe: identity and capabilities, of the session (None: not open) and of what a cycle took.
    """

    def __init__(
        self,
        device: str,
        modes: frozenset[Mode],
        lateness: Lateness,
        connect: Callable[[], SessionT],
        describe: Callable[[SessionT | None, CycleTime | None], Description],
    ) -> None:
        self._device, self._modes, self._lateness = device, modes, lateness
        self._connect, self._describe = connect, describe
        self._session: SessionT | None = None
        self._cycle_time: CycleTime | None = None
        self._mode = Mode.OFF

    def describe(self) -> Description:
        """Identity and capabilities; complete once it is open."""
        return self._describe(self._session, self._cycle_time)

    def open(self, period_s: float) -> None:
        """Connect, identify, switch off, set the watchdog and read it back, and find out how quick a cycle is."""
        self.close()
        self._lateness.check_period(period_s)
        self._session = self._connect()
        try:
            self._cycle_time = measure_cycle(lambda: self.exchange(_OFF))
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Power off and give the port back."""
        session, self._session = self._session, None
        self._mode = Mode.OFF
        if session is not None:
            session.leave()

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand; in POSITION with the present one.

        Raises:
            DriveConfigurationError: a mode that it does not have.
            DriveStateError: it is not open, has a fault, or does not switch on.
            DriveConnectionError: no valid answer in time.
        """
        session = self._opened("enable")
        check_mode(self._device, mode, self._modes)
        self._mode = Mode.OFF
        try:
            session.switch_on(mode)
        except BaseException:
            with suppress(DriveError):
                session.switch_off()
            raise
        self._lateness.told(perf_counter())
        self._mode = mode

    def disable(self) -> None:
        """Power off; a fault stays until it is cleared."""
        session, self._mode = self._opened("disable"), Mode.OFF
        session.switch_off()

    def quick_stop(self) -> None:
        """Brake, in the drive's own way, during the exchanges that follow."""
        session, self._mode = self._opened("quick_stop"), Mode.OFF
        session.begin_quick_stop()

    def inspect(self) -> Inspection:
        """State, fault and applied output; nothing is written."""
        return self._opened("inspect").inspect()

    def clear_fault(self) -> None:
        """Acknowledge a fault. The drive is left disabled."""
        session, self._mode = self._opened("clear_fault"), Mode.OFF
        session.clear_fault()
        if session.state is Status.FAULT:
            raise not_cleared(self._device, session.fault_text())

    def exchange(self, command: Command) -> Sample:
        """Send a demand, and return the sample of this cycle."""
        session = self._ready(command)
        if command.mode is Mode.OFF:
            return session.rest()
        sent_s = perf_counter()
        sample = session.move(command.mode, command.value)
        self._lateness.told(sent_s)
        return sample

    def _ready(self, command: Command) -> SessionT:
        """The session that is to be sent a demand; one that must not be sent is refused."""
        session = self._opened("exchange")
        if command.mode is Mode.OFF:
            self._mode = Mode.OFF
        else:
            self._check_motion(session, command.mode, command.value)
        return session

    def _opened(self, call: str) -> SessionT:
        """The session, whose questions share one time limit from now on."""
        session = self._session
        if session is None:
            raise not_open(self._device, call)
        session.begin()
        return session

    def _check_motion(self, session: SessionT, mode: Mode, value: float) -> None:
        """Refuse a demand that the state does not allow, or that no drive can follow."""
        if session.state is Status.FAULT:
            raise switched_itself_off(self._device, session.fault_text())
        check_mode(self._device, mode, self._modes)
        if session.told is not Status.ENABLED or mode is not self._mode:
            raise not_enabled(self._device, mode, session.told.name.lower())
        limit, unit = _LIMITS[mode]
        check_demand(self._device, mode, value, limit, unit)
        fault = self._lateness.fault()
        if fault is not None:
            self._mode = Mode.OFF
            session.switch_off()
            raise fault
