"""The drive contract on a register map."""

from contextlib import suppress
from time import perf_counter

from drivers.contract import Command, Description, Drive, Inspection, Mode, Sample, Status
from drivers.demand import check_demand, check_mode
from drivers.errors import DriveError
from drivers.joint import JointScale
from drivers.lateness import Lateness
from drivers.modbus.description import ENABLING_S, describe, watchdog_s
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.session import Session
from drivers.modbus.settings import ModbusSettings
from drivers.rate import sustained_rate_hz
from drivers.refusal import not_cleared, not_enabled, not_open, not_to_be_enabled, switched_itself_off

_LIMITS = {Mode.DUTY: (1.0, ""), Mode.CURRENT: (1e3, "A"), Mode.POSITION: (1e3, "rad")}


class ModbusDrive(Drive):
    """One drive with one joint.

    Args:
        settings: how to reach it.
        register_map: what it keeps where.
        joint: scales and signs.
    """

    def __init__(self, settings: ModbusSettings, register_map: RegisterMap, joint: JointScale) -> None:
        self._settings, self._map, self._joint = settings, register_map, joint
        self._device = settings.device
        self._lateness = Lateness(self._device, "watchdog", watchdog_s(settings, register_map))
        self._session: Session | None = None
        self._rate_hz = 0.0
        self._mode = Mode.OFF

    # the contract --------------------------------------------------------------------------------

    def describe(self) -> Description:
        """Identity and capabilities; rate, firmware and serial number are known once it is open."""
        return describe(self._settings, self._map, self._joint, self._session, self._rate_hz)

    def open(self, period_s: float) -> None:
        """Connect, identify, switch off, set the watchdog and read it back, and find the rate.

        A fault that says only that the last host went away is cleared; any other stays.

        Raises:
            DriveConnectionError: nothing answers.
            DriveConfigurationError: another drive than that of the map answers.
            WatchdogError: the watchdog cannot be set, or not be verified.
        """
        self.close()
        self._lateness.check_period(period_s)
        self._session = Session(self._settings, self._map, self._joint)
        try:
            self._rate_hz = sustained_rate_hz(lambda: self.exchange(Command(Mode.OFF)))
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
        """
        session = self._opened("enable")
        check_mode(self._device, mode, self._map.modes)
        self._mode = Mode.OFF
        try:
            self._switch_on(session, mode)
        except BaseException:
            with suppress(DriveError):
                session.switch_off()
            raise
        self._lateness.told()
        self._mode = mode

    def disable(self) -> None:
        """Power off."""
        session, self._mode = self._opened("disable"), Mode.OFF
        session.switch_off()

    def quick_stop(self) -> None:
        """Brake, in the drive's own way, during the exchanges that follow."""
        session, self._mode = self._opened("quick_stop"), Mode.OFF
        if session.told is Status.ENABLED:
            session.begin_quick_stop()

    def inspect(self) -> Inspection:
        """State, fault and applied output; nothing is written.

        Raises:
            DriveStateError: it is not open.
            DriveConnectionError: no answer in time.
        """
        return self._opened("inspect").inspect()

    def clear_fault(self) -> None:
        """Acknowledge a fault. The drive is left disabled.

        Raises:
            DriveFault: its cause is still there.
        """
        session, self._mode = self._opened("clear_fault"), Mode.OFF
        session.clear_fault()
        if session.state is Status.FAULT:
            raise not_cleared(self._device, session.fault_text())

    def exchange(self, command: Command) -> Sample:
        """Send a demand, and return the sample of this cycle.

        Raises:
            DriveFault: the drive reports a fault.
            DriveStateError: it is not open, or motion was commanded in a mode that is not enabled.
            DriveConfigurationError: a demand that is not finite or out of range; nothing was sent.
            DriveConnectionError: no valid answer within the time limit.
        """
        session = self._opened("exchange")
        mode, value, asked_s = command.mode, command.value, perf_counter()
        if mode is Mode.OFF:
            self._mode = Mode.OFF
            if session.told is Status.ENABLED:
                session.told = Status.DISABLED
            values = session.rest()
        else:
            self._check_motion(session, mode, value)
            values = session.move(mode, value)
            self._lateness.told()
        return session.sample(values, asked_s)

    # the inside ----------------------------------------------------------------------------------

    def _opened(self, call: str) -> Session:
        """The session, whose requests share one time limit from now on."""
        if self._session is None:
            raise not_open(self._device, call)
        self._session.link.begin()
        return self._session

    def _switch_on(self, session: Session, mode: Mode) -> None:
        session.told = Status.ENABLED
        deadline_s = perf_counter() + ENABLING_S
        session.stay(mode)
        while session.state is not Status.ENABLED:
            if session.state is Status.FAULT:
                raise not_to_be_enabled(self._device, session.fault_text())
            if perf_counter() > deadline_s:
                raise not_to_be_enabled(self._device, session.state.name.lower())
            session.stay(mode)

    def _check_motion(self, session: Session, mode: Mode, value: float) -> None:
        """Refuse a demand that the state does not allow, or that no drive can follow."""
        if session.state is Status.FAULT:
            raise switched_itself_off(self._device, session.fault_text())
        check_mode(self._device, mode, self._map.modes)
        if session.told is not Status.ENABLED or mode is not self._mode:
            raise not_enabled(self._device, mode, session.told.name.lower())
        limit, unit = _LIMITS[mode]
        check_demand(self._device, mode, value, limit, unit)
        fault = self._lateness.fault()
        if fault is not None:
            self._mode = Mode.OFF
            session.switch_off()
            raise fault
