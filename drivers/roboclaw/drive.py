"""The drive contract on one motor of a RoboClaw: signed duty in; position, applied duty, current, supply out."""

import time
from math import ceil

from drivers.contract import Command, Description, Drive, Mode, Sample, Status
from drivers.demand import check_demand, check_mode
from drivers.errors import (
    DriveConfigurationError,
    DriveConnectionError,
    DriveError,
    DriveFault,
    DriveStateError,
    WatchdogError,
)
from drivers.joint import JointScale
from drivers.roboclaw import commands
from drivers.roboclaw.commands import DUTY_FULL
from drivers.roboclaw.identity import Identity, parse_version
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import WATCHDOG_STEP_S, RoboclawSettings
from drivers.roboclaw.telemetry import Telemetry

MODES = frozenset({Mode.DUTY})
_UNKNOWN = Identity("", "", simulated=False)
_TRIED_CYCLES = 15  # at connect, to find the rate
_STANDING_CYCLES = 3  # without a count: the joint stands
_OPENING_QUESTIONS = 12  # at most, of which each may be met with silence


class RoboclawDrive(Drive):
    """One brushed DC motor with its encoder.

    A RoboClaw has no state of its own between a demand and the next: a duty of 0 brakes, the serial time-out
    (commands 14 and 15) stops the motor, a fault stops it too. The states of the contract are kept here.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        self._settings, self._joint = settings, joint
        self._device = f"{settings.port} address {settings.address:#x} M{settings.motor}"
        self._set_duty = commands.CHANNELS[settings.motor].set_duty
        self._watchdog_steps = max(1, ceil(settings.watchdog_s / WATCHDOG_STEP_S - 1e-9))
        self._watchdog_s = self._watchdog_steps * WATCHDOG_STEP_S
        self._link: Link | None = None
        self._telemetry: Telemetry | None = None
        self._identity = _UNKNOWN
        self._rate_hz = 0.0
        self._state = Status.DISABLED
        self._told_s = 0.0  # when the last demand went out
        self._told_counts = 0  # that demand
        self._silent_until_s = 0.0
        self._rest_rad, self._standing = 0.0, 0

    # the contract --------------------------------------------------------------------------------

    def describe(self) -> Description:
        """Identity and capabilities; what is measured and the rate are known once it is open."""
        telemetry, link_s = self._telemetry, Link.longest_call_s(self._settings)
        return Description(
            device=self._device,
            vendor="Basicmicro",
            product=self._identity.product,
            firmware=self._identity.firmware,
            serial="",
            simulated=self._identity.simulated,
            modes=MODES,
            measured=frozenset() if telemetry is None else telemetry.measured,
            resolution={} if telemetry is None else telemetry.resolution,
            max_rate_hz=self._rate_hz,
            watchdog_s=self._watchdog_s,
            longest_call_s=link_s,
            longest_open_s=_OPENING_QUESTIONS * link_s,
        )

    def open(self, period_s: float) -> None:
        """Connect, identify, stop the motor, set the serial time-out and read it back, and find the rate.

        Raises:
            DriveConnectionError: the port is not there, or nothing answers on it.
            DriveConfigurationError: what answers is no RoboClaw, or the time-out is shorter than the period.
            WatchdogError: the serial time-out cannot be set.
        """
        self.close()
        if self._watchdog_s <= period_s:
            raise DriveConfigurationError(
                self._device,
                f"its serial time-out would be {self._watchdog_s:g} s, and the control period is {period_s:g} s; "
                "a longer time-out is wanted: change watchdog_s",
            )
        self._link = Link(self._settings, self._device)
        self._silent_until_s = 0.0
        try:
            self._identity = self._identify(self._link)
            self._tell(0)
            self._set_watchdog(self._link)
            self._telemetry = Telemetry(self._link, self._settings, self._joint)
            self._rate_hz = self._measure_rate()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Stop the motor and give the port back."""
        link = self._link
        if link is None:
            return
        try:
            if time.perf_counter() >= self._silent_until_s:
                self._tell(0)
        except DriveError:
            pass  # who does not answer any more is stopped by the serial time-out
        finally:
            self._link = self._telemetry = None
            self._state = Status.DISABLED
            link.close()

    def enable(self, mode: Mode) -> None:
        """Let demands through, from a duty of 0 on.

        Raises:
            DriveConfigurationError: a mode other than duty.
            DriveStateError: it is not open, or has a fault.
            DriveConnectionError: no answer in time.
        """
        link, telemetry = self._opened("enable")
        check_mode(self._device, mode, MODES)
        link.begin()
        faults = telemetry.read_status()
        if faults:
            self._state = Status.FAULT
            raise DriveStateError(
                self._device, f"cannot be enabled: {_listed(faults)}; remove the cause, then clear the fault"
            )
        self._tell(0)
        self._state = Status.ENABLED

    def disable(self) -> None:
        """Set the duty to 0; a fault stays until it is cleared."""
        link, _ = self._opened("disable")
        if self._state is not Status.FAULT:
            self._state = Status.DISABLED
        link.begin()
        self._tell(0)

    def quick_stop(self) -> None:
        """Brake with a duty of 0, until the count stands still."""
        link, _ = self._opened("quick_stop")
        link.begin()
        if self._state is Status.ENABLED:
            self._state = Status.QUICK_STOP
            self._standing = 0
        try:
            self._tell(0)
        except DriveConnectionError:
            self._fall_silent(link)
            raise

    def clear_fault(self) -> None:
        """Ask whether the fault is gone. The drive is left disabled.

        Raises:
            DriveFault: its cause is still there.
        """
        link, telemetry = self._opened("clear_fault")
        link.begin()
        self._tell(0)
        faults = telemetry.read_status()
        if faults:
            raise DriveFault(self._device, f"cannot be cleared: {_listed(faults)}; remove the cause, then clear it")
        self._state = Status.DISABLED

    def exchange(self, command: Command) -> Sample:
        """Send a duty, and ask for the sample of this cycle.

        Raises:
            DriveFault: the controller reports a fault, or its serial time-out has passed.
            DriveStateError: it is not open, or motion was commanded while it is not enabled.
            DriveConfigurationError: a mode other than duty, or a duty outside -1 .. 1.
            DriveConnectionError: no valid answer within the time limit.
        """
        mode, value = command.mode, command.value
        link, telemetry = self._opened("exchange")
        link.begin()
        if mode is Mode.OFF:
            if self._state is Status.ENABLED:
                self._state = Status.DISABLED
            counts = 0
        else:
            self._check_motion(mode, value)
            counts = round(self._joint.motor_sign * value * DUTY_FULL)
        try:
            sample = self._cycle(telemetry, counts)
        except DriveConnectionError:
            self._fall_silent(link)
            raise
        if telemetry.faults and self._state is not Status.FAULT:
            self._trip()
            sample = sample._replace(status=self._state)
        if self._state is Status.QUICK_STOP:
            self._watch_braking(sample.position_rad)
        return sample

    # the inside ----------------------------------------------------------------------------------

    def _cycle(self, telemetry: Telemetry, counts: int) -> Sample:
        before = self._told_counts
        self._tell(counts)
        sample = telemetry.sample(self._state)
        if before and not sample.duty:  # demanded and not applied: something has switched it off
            telemetry.read_status()
        return sample

    def _opened(self, call: str) -> tuple[Link, Telemetry]:
        if self._link is None or self._telemetry is None:
            raise DriveStateError(self._device, f"{call} before open; call open(period_s) first")
        if time.perf_counter() < self._silent_until_s:
            raise DriveConnectionError(
                self._device,
                f"did not answer, and is left in silence so that its serial time-out ({self._watchdog_s:g} s) stops "
                "the motor; check the cable, then open it again",
            )
        return self._link, self._telemetry

    def _identify(self, link: Link) -> Identity:
        link.begin()
        text = link.version()
        identity = parse_version(text)
        if identity is None:
            raise DriveConfigurationError(
                self._device, f"what answers calls itself '{text.strip()}'; a RoboClaw is wanted. Check drive.port"
            )
        return identity

    def _set_watchdog(self, link: Link) -> None:
        """Set the serial time-out, and see that it is set."""
        link.begin()
        try:
            link.write(commands.SET_TIMEOUT, self._watchdog_steps)
            found = link.read(commands.READ_TIMEOUT)[0]
        except DriveConnectionError as error:
            raise WatchdogError(self._device, f"its serial time-out cannot be set: {error}") from error
        if found != self._watchdog_steps:
            raise WatchdogError(
                self._device,
                f"its serial time-out reads back as {found * WATCHDOG_STEP_S:g} s, set was {self._watchdog_s:g} s; "
                "power it off and on, and look at its firmware",
            )

    def _measure_rate(self) -> float:
        """Whole cycles, one after the other, with a duty of 0: how many a second it sustains [Hz].

        The quickest counts: a busy host is no fault of the drive, and is seen in the cycles that are lost later.
        """
        lasted_s = []
        for _ in range(_TRIED_CYCLES):
            began_s = time.perf_counter()
            self.exchange(Command(Mode.OFF))
            lasted_s.append(time.perf_counter() - began_s)
        return 1.0 / min(lasted_s)

    def _tell(self, counts: int) -> None:
        """Send a duty [1/32767]."""
        assert self._link is not None
        self._told_counts = counts
        self._link.write(self._set_duty, counts)
        self._told_s = time.perf_counter()

    def _fall_silent(self, link: Link) -> None:
        """Where it does not answer: one last word, then none, as every byte may put off its serial time-out."""
        if self._state in (Status.ENABLED, Status.QUICK_STOP):
            link.shout(self._set_duty, 0)
            self._silent_until_s = time.perf_counter() + self._watchdog_s
            self._state = Status.DISABLED

    def _check_motion(self, mode: Mode, value: float) -> None:
        """Refuse a demand that the state does not allow, or that no drive can follow."""
        if self._state is Status.FAULT:
            faults = self._telemetry.faults if self._telemetry else []
            raise DriveFault(
                self._device, f"has switched itself off: {_listed(faults)}; remove the cause, then clear the fault"
            )
        check_mode(self._device, mode, MODES)
        if self._state is not Status.ENABLED:
            raise DriveStateError(
                self._device, f"a duty was demanded in state {self._state.name.lower()}; enable duty mode first"
            )
        check_demand(self._device, mode, value, 1.0, "")
        silent_s = time.perf_counter() - self._told_s
        if silent_s > self._watchdog_s:
            self._state = Status.DISABLED
            self._tell(0)
            raise DriveFault(
                self._device,
                f"its serial time-out has stopped the motor: no demand for {silent_s:.3g} s, {self._watchdog_s:g} s "
                "are allowed; see what kept the host busy, then start again",
            )

    def _trip(self) -> None:
        """A fault was reported: the demand goes back to 0, so that the motor does not start when the fault goes."""
        self._state = Status.FAULT
        self._tell(0)

    def _watch_braking(self, position_rad: float) -> None:
        """Power off once the joint stands."""
        self._standing = self._standing + 1 if position_rad == self._rest_rad else 0
        self._rest_rad = position_rad
        if self._standing >= _STANDING_CYCLES:
            self._state = Status.DISABLED


def _listed(faults: list[str]) -> str:
    return ", ".join(faults) or "a fault that is gone by now"
