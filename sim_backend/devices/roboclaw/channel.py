"""One motor channel: what it was told, the duty that follows from it, and the counter of its encoder."""

from dataclasses import dataclass, field
from enum import IntFlag

from sim_backend.devices.axis import TICK_S
from sim_backend.faults.script import OverTemperature, SupplyLost, Trip

PID = tuple[int, int, int, int]  # P, I, D as 16.16 fixed point, and the speed at full duty [pulses/s]

DEFAULT_PID: PID = (0x00010000, 0x00008000, 0x00004000, 44000)
_WRAP = 1 << 32
UNDERFLOW, BACKWARD, OVERFLOW = 1, 2, 4


@dataclass
class Settings:
    """Raw, in the units of the wire."""

    serial_timeout: int = 0  # 100 ms; 0 is off
    pwm_mode: int = 1
    main_limits: tuple[int, int] = (60, 340)  # 0.1 V
    logic_limits: tuple[int, int] = (55, 340)
    velocity_pids: list[PID] = field(default_factory=lambda: [DEFAULT_PID, DEFAULT_PID])
    encoder_modes: list[int] = field(default_factory=lambda: [0, 0])
    current_limits: list[tuple[int, int]] = field(default_factory=lambda: [(1500, 0), (1500, 0)])  # 10 mA


class Flag(IntFlag):
    """The bits that this device can set, by the manual's names."""

    E_STOP = 0x00000001
    TEMPERATURE = 0x00000002
    MOTOR_1_DRIVER = 0x00000040
    MOTOR_1_CURRENT_WARNING = 0x00010000
    MAIN_LOW_WARNING = 0x00080000
    TEMPERATURE_WARNING = 0x00100000


WARM_C = 85.0  # the drive begins to limit here, and says so


def flag_of(trip: Trip) -> Flag:
    """Return the flag that stands for what has switched the drive off."""
    if isinstance(trip, OverTemperature):
        return Flag.TEMPERATURE
    return Flag.MAIN_LOW_WARNING if isinstance(trip, SupplyLost) else Flag.MOTOR_1_DRIVER


class Counter:
    """Counts of one encoder."""

    def __init__(self) -> None:
        self._offset = 0
        self._raw = 0
        self._lap = 0
        self._flags = 0

    def follow(self, raw: int) -> None:
        """Take the encoder's own count."""
        if raw != self._raw:
            self._flags = self._flags & ~BACKWARD | (BACKWARD if raw < self._raw else 0)
        self._raw = raw
        lap = (raw - self._offset) // _WRAP
        if lap != self._lap:
            self._flags |= OVERFLOW if lap > self._lap else UNDERFLOW
        self._lap = lap

    def value(self) -> int:
        """Return the count, 0 .. 2^32 - 1."""
        return (self._raw - self._offset) % _WRAP

    def read(self) -> tuple[int, int]:
        """Return count and flags; having been read, the flags of passed ends are cleared."""
        flags = self._flags
        self._flags &= BACKWARD
        return self.value(), flags

    def set(self, value: int) -> None:
        """Let the present count be this."""
        self._offset = self._raw - value
        self._lap = value // _WRAP


FULL_DUTY = 32767
_FIXED_POINT = 65536.0
_RECOVERY = 1.02  # of a limited duty, per tick


class Channel:
    """Duty, ramped duty or speed control, within a current limit.

    The manual does not print the speed controller's equation. Here: duty = (target + P e + I sum(e) dt) / QPPS, e the
    error in pulses/s; D is stored and not used.
    """

    def __init__(self) -> None:
        self.limited = False
        self._share = 1.0  # of the duty, that the current limit leaves
        self._closes_speed = False
        self._target = 0.0  # duty
        self._now = 0.0  # duty, on its way there
        self._rate: float | None = None  # duty a second; None is at once
        self._speed = 0
        self._sum = 0.0  # of speed errors [pulses]

    def stop(self) -> None:
        """Stop at once."""
        self._set_duty(0.0, None)

    def drive(self, duty: int, acceleration: int | None = None) -> None:
        """Take a duty, +-32767; with an acceleration [counts/s] it is approached."""
        self._set_duty(max(-1.0, min(1.0, duty / FULL_DUTY)), acceleration)

    def turn(self, speed: int) -> None:
        """Take a speed [pulses/s], closed by the drive."""
        self._speed = speed
        self._closes_speed = True

    def duty(self, speed: float, pid: PID, current_a: float, limit_a: float) -> float:
        """Return the duty of the coming tick.

        Args:
            speed: measured [pulses/s].
            pid: of the speed controller.
            current_a: measured [A].
            limit_a: largest current [A].
        """
        wanted = self._controlled(speed, pid) if self._closes_speed else self._ramped()
        self._limit(abs(current_a), limit_a)
        return wanted * self._share

    def _set_duty(self, duty: float, acceleration: int | None) -> None:
        self._closes_speed = False
        self._target = duty
        self._rate = None if acceleration is None else acceleration / FULL_DUTY
        self._sum = 0.0
        self._speed = 0
        if self._rate is None:
            self._now = duty

    def _ramped(self) -> float:
        if self._rate is not None:
            step = self._rate * TICK_S
            self._now += max(-step, min(step, self._target - self._now))
        return self._now

    def _controlled(self, speed: float, pid: PID) -> float:
        p, i, _, full_speed = pid
        if full_speed == 0:
            return 0.0
        error = self._speed - speed
        reach = full_speed * _FIXED_POINT / i if i else 0.0
        self._sum = max(-reach, min(reach, self._sum + error * TICK_S))
        duty = (self._speed + (p * error + i * self._sum) / _FIXED_POINT) / full_speed
        self._now = max(-1.0, min(1.0, duty))
        return self._now

    def _limit(self, current_a: float, limit_a: float) -> None:
        if current_a > limit_a:
            self._share *= limit_a / current_a
        else:
            self._share = min(self._share * _RECOVERY, 1.0)
        self.limited = self._share < 1.0
