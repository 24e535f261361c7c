"""A connected actuator and the state that it is in: told, asked, or left in silence so that its watchdog stops it."""

from collections.abc import Callable
from math import isfinite
from time import perf_counter
from typing import Generic, TypeVar

from drivers.actuator.actuator import Actuator
from drivers.actuator.reading import Reading, sample_of
from drivers.contract import Inspection, Mode, Sample, Status
from drivers.errors import DriveConnectionError, DriveError
from drivers.joint import JointScale, Standstill
from drivers.refusal import not_to_be_enabled

_LONGEST_BRAKING_S = 1.0
_POWERED = (Status.ENABLED, Status.QUICK_STOP)
_LAST_WORDS = 3  # of one that has no watchdog

ActuatorT = TypeVar("ActuatorT", bound=Actuator)


class ActuatorSession(Generic[ActuatorT]):
    """Everything between connecting and disconnecting.

    Args:
        device: name used in messages.
        connect: makes the actuator; the power is off then, and its watchdog set.
        joint: scales and signs.
        watchdog_s: silence after which it stops by itself [s]; None: it never does.
    """

    def __init__(
        self, device: str, connect: Callable[[], ActuatorT], joint: JointScale, watchdog_s: float | None
    ) -> None:
        self._device, self._joint, self._watchdog_s = device, joint, watchdog_s
        self.told = Status.DISABLED
        self._fault = ""
        self._silent_until_s = self._brakes_until_s = 0.0
        self._braking = Standstill()
        self.actuator = connect()

    @property
    def state(self) -> Status:
        """FAULT from the first report of one until it is cleared; else what was told last."""
        return Status.FAULT if self._fault else self.told

    def begin(self) -> None:
        """A call of the contract begins.

        Raises:
            DriveConnectionError: it did not answer, and its watchdog is waited for in silence.
        """
        if perf_counter() < self._silent_until_s:
            raise DriveConnectionError(
                self._device,
                f"did not answer, and is left in silence so that its watchdog ({self._watchdog_s:g} s) stops the "
                "motor; check the cable and the power, then open it again",
            )
        self.actuator.begin()

    def switch_on(self, mode: Mode) -> None:
        """Power the stage with a demand that moves nothing."""
        here = self.actuator.ask()
        if here.fault:
            self._fault = here.fault
            raise not_to_be_enabled(self._device, here.fault)
        self._fault = ""
        self.told = Status.ENABLED  # before the call: one that fails half-way may have powered the stage
        self.actuator.switch_on(mode, here)

    def switch_off(self) -> None:
        """Power off."""
        try:
            self.actuator.switch_off()
        except DriveConnectionError:
            self.give_up()
            raise
        self.told = Status.DISABLED

    def begin_quick_stop(self) -> None:
        """Brake where it is enabled; `rest` goes on with it, and powers off in the end."""
        if self.state is not Status.ENABLED:
            return
        self.told = Status.QUICK_STOP
        self._braking.restart()
        self._brakes_until_s = perf_counter() + _LONGEST_BRAKING_S
        self.rest()

    def clear_fault(self) -> None:
        """Acknowledge a fault, and leave the power off."""
        self.told = Status.DISABLED
        self.actuator.switch_off()
        self.actuator.clear_fault()
        self._fault = self.actuator.ask().fault

    def move(self, mode: Mode, value: float) -> Sample:
        """One cycle with a demand [duty, A, N m or rad of the joint]."""
        return self._cycle(*self.demand(mode, value))

    def rest(self) -> Sample:
        """One cycle without a demand: the power goes off, or a quick stop goes on."""
        return self._cycle(*self.demand(Mode.OFF, 0.0))

    def demand(self, mode: Mode, value: float) -> tuple[Mode, float]:
        """What is to be sent for a demand [duty, A, N m or rad of the joint], or for none, in the actuator's sense."""
        if mode is Mode.OFF:
            if self.told is Status.QUICK_STOP:
                return self.actuator.braking()
            if self.told is Status.ENABLED:
                self.switch_off()
            return mode, 0.0
        if mode is Mode.POSITION:
            return mode, float(self._joint.counts(value))
        return mode, self._joint.motor_sign * value

    def take(self, reading: Reading) -> Sample:
        """What was answered; a fault is followed by power-off, so that the motor does not start when the fault goes."""
        if reading.fault and not self._fault:
            self._fault = reading.fault
            self.switch_off()
        elif self.told is Status.ENABLED and not reading.is_on and not self._fault:
            self._fault = "its power stage is off, and nobody here has told it so"
            self.switch_off()
        sample = sample_of(reading, self._joint, self.state)
        if self.told is Status.QUICK_STOP:
            # a position that is none does not tell: the time of a quick stop does
            stands = isfinite(reading.counts) and self._braking.stands(round(reading.counts))
            if stands or perf_counter() > self._brakes_until_s:
                self.switch_off()
        return sample

    def give_up(self) -> None:
        """It does not answer: last words, and then none, as any may put off its watchdog."""
        was, self.told = self.told, Status.DISABLED
        if was not in _POWERED:
            return
        for _ in range(_LAST_WORDS if self._watchdog_s is None else 1):
            self.actuator.shout_off()
        if self._watchdog_s is not None:
            self._silent_until_s = perf_counter() + self._watchdog_s

    def inspect(self) -> Inspection:
        """State, fault and applied output, by questions alone."""
        found, sign = self.actuator.ask(), self._joint.motor_sign
        status = Status.ENABLED if found.is_on else Status.DISABLED
        return Inspection(
            Status.FAULT if found.fault else status, found.fault, sign * found.duty, sign * found.current_a
        )

    def fault_text(self) -> str:
        """The fault in words."""
        return self._fault or "a fault that is gone by now"

    def leave(self) -> None:
        """Power off where it answers, and give the port back; otherwise its watchdog stops it."""
        try:
            if perf_counter() >= self._silent_until_s:
                self.actuator.begin()
                self.switch_off()
        except DriveError:
            pass
        finally:
            self.actuator.close()

    def _cycle(self, mode: Mode, raw: float) -> Sample:
        try:
            reading = self.actuator.exchange(mode, raw)
        except DriveConnectionError:
            self.give_up()
            raise
        return self.take(reading)
