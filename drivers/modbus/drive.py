"""The drive contract on a register map."""

import time
from math import nan

from drivers.contract import Command, Description, Drive, Mode, Sample, Status
from drivers.demand import check_demand, check_mode
from drivers.errors import (
    DriveConfigurationError,
    DriveError,
    DriveFault,
    DriveStateError,
)
from drivers.joint import JointScale
from drivers.modbus.link import Link
from drivers.modbus.opening import UNKNOWN, identify, set_watchdog
from drivers.modbus.power_stage import state_of, word_of
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.requests import Values, plan
from drivers.modbus.sampling import Sampling
from drivers.modbus.settings import ModbusSettings

_TRIED_CYCLES = 15  # at connect, to find the rate
_ENABLING_S = 0.5  # longest wait for the drive to say that it is on
_STANDING_CYCLES = 3
_OPENING_REQUESTS = 12
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
        self._plan = plan(register_map)
        self._link: Link | None = None
        self._identity = UNKNOWN
        self._watchdog_s = settings.watchdog_s if register_map.watchdog.register else register_map.watchdog.fixed_s
        self._rate_hz = 0.0
        self._told = Status.DISABLED  # what the drive was last told to be
        self._mode = Mode.OFF
        self._state = Status.DISABLED  # what it says it is
        self._fault = 0
        self._sampling = Sampling(register_map, joint)
        self._cycle = 0
        self._told_s = 0.0
        self._rest_counts, self._standing = nan, 0

    # the contract --------------------------------------------------------------------------------

    def describe(self) -> Description:
        """Identity and capabilities; rate, firmware and serial number are known once it is open."""
        link_s = Link.longest_call_s(self._settings)
        return Description(
            device=self._device,
            vendor=self._map.identity.vendor,
            product=self._identity.product or self._map.identity.product,
            firmware=self._identity.firmware,
            serial=self._identity.serial,
            simulated=self._identity.simulated,
            modes=self._map.modes,
            measured=self._sampling.measured,
            resolution=self._sampling.resolution,
            max_rate_hz=self._rate_hz,
            watchdog_s=self._watchdog_s,
            longest_call_s=link_s + _ENABLING_S,
            longest_open_s=_OPENING_REQUESTS * link_s + _ENABLING_S,
        )

    def open(self, period_s: float) -> None:
        """Connect, identify, switch off, set the watchdog and read it back, and find the rate.

        Raises:
            DriveConnectionError: nothing answers.
            DriveConfigurationError: another drive than that of the map answers.
            WatchdogError: the watchdog cannot be set, or not be verified.
        """
        self.close()
        if self._watchdog_s <= period_s:
            raise DriveConfigurationError(
                self._device,
                f"its watchdog would be {self._watchdog_s:g} s, and the control period is {period_s:g} s; a longer one "
                "is wanted: change watchdog_s",
            )
        self._link = Link(self._settings)
        try:
            self._link.begin()
            self._identity = identify(self._link, self._map, self._device)
            self._switch_off()
            self._link.begin()
            set_watchdog(self._link, self._map, self._settings)
            self._read_slow()
            self._rate_hz = self._measure_rate()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Power off and give the port back."""
        link = self._link
        if link is None:
            return
        try:
            self._switch_off()
        except DriveError:
            pass  # who does not answer any more is stopped by its watchdog
        finally:
            self._link = None
            self._told = self._state = Status.DISABLED
            link.close()

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand; in POSITION with the present one.

        Raises:
            DriveConfigurationError: a mode that it does not have.
            DriveStateError: it is not open, has a fault, or does not switch on.
        """
        self._opened("enable").begin()
        check_mode(self._device, mode, self._map.modes)
        values = self._transact(self._command(mode, self._neutral(mode)))
        deadline_s = time.perf_counter() + _ENABLING_S
        self._told = Status.ENABLED
        while self._follow(values) is not Status.ENABLED:
            if self._state is Status.FAULT or time.perf_counter() > deadline_s:
                self._told = Status.DISABLED
                state = self._fault_text() if self._state is Status.FAULT else self._state.name.lower()
                raise DriveStateError(
                    self._device, f"cannot be enabled: {state}; remove the cause, clear the fault, then enable it again"
                )
            values = self._transact(self._command(mode, self._neutral(mode)))
        self._mode = mode

    def disable(self) -> None:
        """Power off."""
        self._opened("disable")
        self._switch_off()

    def quick_stop(self) -> None:
        """Brake, in the drive's own way, during the exchanges that follow."""
        self._opened("quick_stop").begin()
        if self._told is Status.ENABLED:
            self._told, self._mode, self._standing = Status.QUICK_STOP, Mode.OFF, 0
            self._follow(self._transact(self._rest()))

    def clear_fault(self) -> None:
        """Acknowledge a fault. The drive is left disabled.

        Raises:
            DriveFault: its cause is still there.
        """
        self._opened("clear_fault").begin()
        clearing = word_of(self._map.control, "clear_fault")
        if clearing:
            self._transact(self._zero() | clearing)
        self._switch_off()
        if self._state is Status.FAULT:
            raise DriveFault(self._device, f"cannot be cleared: {self._fault_text()}; remove the cause, then clear it")

    def exchange(self, command: Command) -> Sample:
        """Send a demand, and return the sample of this cycle.

        Raises:
            DriveFault: the drive reports a fault.
            DriveStateError: it is not open, or motion was commanded in a mode that is not enabled.
            DriveConfigurationError: a demand that is not finite or out of range; nothing was sent.
            DriveConnectionError: no valid answer within the time limit.
        """
        self._opened("exchange").begin()
        mode, value = command.mode, command.value
        if mode is Mode.OFF:
            if self._told is Status.ENABLED:
                self._told, self._mode = Status.DISABLED, Mode.OFF
            values = self._transact(self._rest())
        else:
            self._check_motion(mode, value)
            values = self._transact(self._command(mode, value))
        now_s = time.perf_counter()
        self._follow(values)
        self._cycle += 1
        if self._plan.slow and self._cycle % self._settings.slow_every == 0:
            self._read_slow()
        return self._sampling.sample(values, self._state, now_s)

    # the inside ----------------------------------------------------------------------------------

    def _opened(self, call: str) -> Link:
        if self._link is None:
            raise DriveStateError(self._device, f"{call} before open; call open(period_s) first")
        return self._link

    def _transact(self, values: Values) -> Values:
        link = self._opened("a request")
        try:
            found = self._plan.cycle(link, values)
        except ValueError as error:
            raise DriveConfigurationError(self._device, f"{error}. Limit the demand") from error
        self._told_s = time.perf_counter()
        return found

    def _follow(self, values: Values) -> Status:
        """Take over the state that the drive reports."""
        self._state = state_of(self._map, values, self._told)
        self._fault = int(values[self._map.fault.name]) if self._map.fault is not None else 0
        if self._told is Status.QUICK_STOP and self._has_stopped(values):
            self._told = Status.DISABLED
        return self._state

    def _has_stopped(self, values: Values) -> bool:
        """Whether a quick stop is over: by the drive's own word, or where it has none by its count."""
        if self._map.status is not None and "quick_stop" in self._map.status.words:
            return self._state is not Status.QUICK_STOP
        counts = values[self._map.measured["position_counts"].name]
        self._standing = self._standing + 1 if counts == self._rest_counts else 0
        self._rest_counts = counts
        return self._standing >= _STANDING_CYCLES

    def _switch_off(self) -> None:
        self._opened("off").begin()
        self._told, self._mode = Status.DISABLED, Mode.OFF
        self._follow(self._transact(self._rest()))

    def _zero(self) -> Values:
        """Every demand that is not a position at zero."""
        return {register.name: 0.0 for mode, register in self._map.demand.items() if mode is not Mode.POSITION}

    def _rest(self) -> Values:
        """What is written while nothing is demanded."""
        name = "quick_stop" if self._told is Status.QUICK_STOP else "off"
        return self._zero() | (word_of(self._map.control, name) or word_of(self._map.control, "off"))

    def _command(self, mode: Mode, value: float) -> Values:
        """What is written for a demand [duty, A or rad of the joint]."""
        raw = float(self._joint.counts(value)) if mode is Mode.POSITION else self._joint.motor_sign * value
        words = word_of(self._map.control, mode.value) | word_of(self._map.mode, mode.value)
        return self._zero() | words | {self._map.demand[mode].name: raw}

    def _neutral(self, mode: Mode) -> float:
        """The demand that moves nothing."""
        if mode is not Mode.POSITION:
            return 0.0
        link = self._opened("enable")
        register = self._map.measured["position_counts"]
        return self._joint.position_rad(link.read_one(register))

    def _check_motion(self, mode: Mode, value: float) -> None:
        if self._state is Status.FAULT:
            raise DriveFault(
                self._device, f"has switched itself off: {self._fault_text()}; remove the cause, then clear the fault"
            )
        check_mode(self._device, mode, self._map.modes)
        if self._told is not Status.ENABLED or mode is not self._mode:
            state = self._told.name.lower()
            raise DriveStateError(
                self._device, f"a {mode.value} was demanded in state {state}; enable {mode.value} mode first"
            )
        limit, unit = _LIMITS[mode]
        check_demand(self._device, mode, value, limit, unit)
        silent_s = time.perf_counter() - self._told_s
        if silent_s > self._watchdog_s:
            self._switch_off()
            raise DriveFault(
                self._device,
                f"its watchdog has stopped the motor: no demand for {silent_s:.3g} s, {self._watchdog_s:g} s are "
                "allowed; see what kept the host busy, then start again",
            )

    def _fault_text(self) -> str:
        return self._map.fault_name(self._fault) if self._map.fault is not None else "a fault that it does not name"

    def _measure_rate(self) -> float:
        """Whole cycles with the power off: how many a second it sustains, by the quickest [Hz]."""
        lasted_s = []
        for _ in range(_TRIED_CYCLES):
            began_s = time.perf_counter()
            self.exchange(Command(Mode.OFF))
            lasted_s.append(time.perf_counter() - began_s)
        return 1.0 / min(lasted_s)

    def _read_slow(self) -> None:
        link = self._opened("exchange")
        for block in self._plan.slow:
            self._sampling.keep(block.decode(link.read(block)))
