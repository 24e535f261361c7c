"""A CANopen drive with the CiA 402 profile, as the drive contract wants it."""

from contextlib import suppress
from math import nan

from drivers.canopen.cia301.link import BusPort, CanLink
from drivers.canopen.cia301.object_table import ObjectUse
from drivers.canopen.cia301.objects import STATUSWORD
from drivers.canopen.cia301.period import check_bus_load, check_period
from drivers.canopen.cia301.sync_cycle import CycleCounts
from drivers.canopen.cia402.demand import Demand
from drivers.canopen.cia402.drive_units import UnitRow
from drivers.canopen.cia402.homing import HomingDemand
from drivers.canopen.cia402.power_stage import PowerStage
from drivers.canopen.cia402.state_machine import State, state_of, status_of, towards_standstill
from drivers.canopen.cia402.stopping import USUAL_SPEED_RAD_S
from drivers.canopen.description import describe
from drivers.canopen.session import Session
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Description, Inspection, Mode, Sample, Status
from drivers.errors import DriveConfigurationError, DriveError, DriveFault, DriveStateError
from drivers.joint import JointScale
from drivers.refusal import check_mode, not_enabled, not_open, switched_itself_off


class CanopenDrive:
    """One drive on a CAN bus. The caller's thread owns the bus; there is no other.

    Attributes:
        port: the bus; another drive's where both are on one, see `share_buses`.
        highest_speed_rad_s: of the joint; from there the drive's own quick stop has to end soon [rad/s].
    """

    def __init__(self, settings: CanopenSettings, joint: JointScale) -> None:
        self._joint = joint
        self.settings = settings
        self._device = settings.device
        self.port = BusPort(settings.bus)
        self.highest_speed_rad_s = USUAL_SPEED_RAD_S
        self._link: CanLink | None = None
        self._session: Session | None = None
        self._power: PowerStage | None = None
        self._demand: Demand | HomingDemand | None = None
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
        return describe(self.settings, self._session)

    def open(self, period_s: float) -> None:
        """Connect: identity, watchdog, limits, PDOs, OPERATIONAL. The power stage stays off.

        Raises:
            DriveConnectionError: the bus is not there, or nobody answers at the node ID.
            DriveConfigurationError: what answers is not the drive that was configured, or the period is too short.
            WatchdogError: the watchdog cannot be set.
        """
        self.close()
        check_period(self.settings, period_s)
        self._link = CanLink(self.port, self._device)
        try:
            self._link.open()
            self._session = Session(self._link, self.settings, self._joint, period_s, self.highest_speed_rad_s)
            self._power = PowerStage(self._session)
            check_bus_load(self.settings, (link.load for link in self.port.links), period_s)
            self._power.forgive_lost_host()
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
                    if self.settings.brake is not None:
                        session.set_brake(self.settings.brake, released=False, confirmed=False)
                    power.switch_off()
                    session.leave()
        finally:
            if link is not None:
                link.close()

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand; in POSITION that is the present position, in HOME no search.

        Raises:
            DriveConfigurationError: the drive does not have the mode, or refuses it; in HOME, what it lacks.
            DriveStateError: it is not open, has a fault, or does not switch on.
            WatchdogError: its watchdog cannot be set.
        """
        session, power = self._opened("enable")
        self._check_mode(session, mode)
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
            DriveStateError: it did not obey, and was reset.
        """
        _, power = self._opened("disable")
        self._mode, self._stopping = Mode.OFF, False
        power.switch_off()

    def quick_stop(self) -> None:
        """Brake on the drive's quick-stop ramp during the exchanges that follow; the drive then powers off.

        Where that ramp is not known to end soon, the power goes off at once.
        """
        session, _ = self._opened("quick_stop")
        self._mode, self._stopping = Mode.OFF, session.stopping.on_ramp
        self._exchange_off()

    def set_brake(self, released: bool, confirmed: bool = True) -> None:
        """Release or set the holding brake; see `drivers.contract.BrakeOutput`."""
        session, _ = self._opened("set_brake")
        if self.settings.brake is None:
            raise DriveConfigurationError(self._device, "no output for a brake was configured; see drive.brake.by")
        session.set_brake(self.settings.brake, released, confirmed)

    def stand_down(self, engage_s: float) -> None:
        """Have it set a brake of its own, then power off; see `drivers.contract.OwnBrake`."""
        _, power = self._opened("stand_down")
        self._mode, self._stopping = Mode.OFF, False
        power.stand_down(engage_s)

    @property
    def objects(self) -> tuple[ObjectUse, ...]:
        """Which objects of the drive are used, and what became of each.

        Raises:
            DriveStateError: it is not open.
        """
        return self._opened("objects")[0].table.rows

    @property
    def units(self) -> tuple[UnitRow, ...]:
        """Units by the drive and by the configuration, side by side.

        Raises:
            DriveStateError: it is not open.
        """
        return self._opened("units")[0].found.units

    @property
    def watchdog(self) -> str:
        """How the drive notices that this host is gone, and what it does then.

        Raises:
            DriveStateError: it is not open.
        """
        return self._opened("watchdog")[0].guard.words

    def inspect(self) -> Inspection:
        """State and fault, by SDO alone: no SYNC, no PDO, no heartbeat is sent."""
        session, _ = self._opened("inspect")
        status = status_of(state_of(session.access.read(STATUSWORD)))
        current = session.found.current
        counts = None if current is None else session.access.read_if_present(current)
        scale = session.found.scale
        current_a = nan
        if current is not None and counts is not None:
            current_a = scale.joint.motor_sign * counts * scale.current_a(current)
        fault = session.fault_name() if status is Status.FAULT else ""
        return Inspection(status, fault, current_a=current_a, torque_off=session.torque_off())

    def clear_fault(self) -> None:
        """Reset a fault. The drive is left disabled."""
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
        demand = self._check_enabled(session, power, command.mode)
        payload = demand.payload(command, session.statusword, session.position_counts)
        session.run(demand.pdo.cob_id, payload)
        if power.state is not State.ENABLED:
            raise self._switched_off(session, power)
        sample = session.sample(status_of(power.state))
        if not isinstance(demand, HomingDemand):
            return sample
        if demand.failed(session.statusword):
            raise self._not_homed(session)
        return sample._replace(homed=demand.attained(session.statusword))

    def _exchange_off(self) -> Sample:
        session, power = self._opened("exchange")
        self._mode = Mode.OFF
        word = towards_standstill(power.state) if self._stopping else 0
        answered = session.run(session.speaking.cob_id, session.nothing(word))
        sample = session.sample(status_of(power.state))
        if answered and sample.status is not Status.QUICK_STOP:
            self._stopping = self._stopping and power.state is State.ENABLED
            if session.guard.armed and sample.status is Status.DISABLED:
                session.guard.disarm()
                session.speaking = session.data.idle
        return sample

    def _opened(self, call: str) -> tuple[Session, PowerStage]:
        if self._session is None or self._power is None:
            raise not_open(self._device, call)
        return self._session, self._power

    def _check_mode(self, session: Session, mode: Mode) -> None:
        if mode is not Mode.HOME:
            check_mode(self._device, mode, frozenset(session.found.modes))
        elif session.found.no_homing:
            raise DriveConfigurationError(
                self._device,
                f"does not home by itself: {session.found.no_homing}; or have the bench look for the end stop "
                "(drive.homing.method = 'end-stop')",
            )

    def _not_homed(self, session: Session) -> DriveStateError:
        return DriveStateError(
            self._device,
            f"its homing ended with an error (bit 13 of the statusword, 0x{session.statusword:04X}): home was not "
            "found; look at its homing method, its switches and the way that the joint is free to go",
        )

    def _check_enabled(self, session: Session, power: PowerStage, mode: Mode) -> Demand | HomingDemand:
        """The demand that goes on, where a mode is enabled."""
        if mode is self._mode and self._demand is not None:
            return self._demand
        if status_of(power.state) is Status.FAULT:
            raise self._switched_off(session, power)
        raise not_enabled(self._device, mode, f"'{power.state.value}'")

    def _switched_off(self, session: Session, power: PowerStage) -> DriveFault:
        named = status_of(power.state) is Status.FAULT or session.emergency is not None
        why = session.fault_name() if named else "no error is reported. Check the enable input (safe torque off)"
        return switched_itself_off(self._device, f"state '{power.state.value}', {why}")
