"""What a cycle asks the controller for, and the sample that comes of it.

Position, applied PWM and current are asked for in every cycle; status, supply voltage and temperature change slowly
and are asked for in turn. The values of one cycle are taken one after the other: each has its own age.
"""

import time
from collections.abc import Callable
from math import copysign, nan
from typing import NamedTuple

from drivers.contract import Ages, Sample, Status
from drivers.errors import DriveConnectionError
from drivers.joint import JointScale
from drivers.roboclaw import commands
from drivers.roboclaw.commands import BACKWARD, CURRENT_A, DUTY_FULL, Read
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import RoboclawSettings

_VOLTAGE_V = 0.1  # of command 24
_TEMPERATURE_C = 0.1  # of command 82
_TURN, _HALF = 1 << 32, 1 << 31  # of the encoder's count


class Flag(NamedTuple):
    """One bit.

    Attributes:
        mask: of the bit.
        name: as the manual has it.
        motor: 1 or 2; 0 where it concerns both.
        is_fault: False for a warning: the motors go on.
    """

    mask: int
    name: str
    motor: int = 0
    is_fault: bool = True


FLAGS_32_BIT = (
    Flag(0x0000_0001, "E-stop"),
    Flag(0x0000_0002, "temperature error"),
    Flag(0x0000_0004, "temperature 2 error"),
    Flag(0x0000_0008, "main voltage too high"),
    Flag(0x0000_0010, "logic voltage too high"),
    Flag(0x0000_0020, "logic voltage too low"),
    Flag(0x0000_0040, "M1 driver fault", 1),
    Flag(0x0000_0080, "M2 driver fault", 2),
    Flag(0x0000_0100, "M1 speed error", 1),
    Flag(0x0000_0200, "M2 speed error", 2),
    Flag(0x0000_0400, "M1 position error", 1),
    Flag(0x0000_0800, "M2 position error", 2),
    Flag(0x0000_1000, "M1 current error", 1),
    Flag(0x0000_2000, "M2 current error", 2),
    Flag(0x0001_0000, "M1 over-current warning", 1, is_fault=False),
    Flag(0x0002_0000, "M2 over-current warning", 2, is_fault=False),
    Flag(0x0004_0000, "main voltage high warning", is_fault=False),
    Flag(0x0008_0000, "main voltage low warning"),  # command 2: below its minimum the motors are not driven
    Flag(0x0010_0000, "temperature warning", is_fault=False),
    Flag(0x0020_0000, "temperature 2 warning", is_fault=False),
)
FLAGS_16_BIT = (
    Flag(0x0001, "M1 over-current warning", 1, is_fault=False),
    Flag(0x0002, "M2 over-current warning", 2, is_fault=False),
    Flag(0x0004, "E-stop"),
    Flag(0x0008, "temperature error"),
    Flag(0x0010, "temperature 2 error"),
    Flag(0x0020, "main voltage too high"),
    Flag(0x0040, "logic voltage too high"),
    Flag(0x0080, "logic voltage too low"),
    Flag(0x0100, "M1 driver fault", 1),
    Flag(0x0200, "M2 driver fault", 2),
    Flag(0x0400, "main voltage high warning", is_fault=False),
    Flag(0x0800, "main voltage low warning"),
    Flag(0x1000, "temperature warning", is_fault=False),
    Flag(0x2000, "temperature 2 warning", is_fault=False),
)


def faults(word: int, flags: tuple[Flag, ...], motor: int) -> list[str]:
    """Names of the faults in a status word that stop one motor.

    Args:
        word: as answered.
        flags: `FLAGS_32_BIT` where the answer has four bytes, `FLAGS_16_BIT` where it has two.
        motor: 1 or 2.
    """
    return [flag.name for flag in flags if word & flag.mask and flag.is_fault and flag.motor in (0, motor)]


class EncoderCount:
    """Follows a count that wraps at 2**32; right as long as less than half of that passes between two readings.

    Args:
        first: the first reading, u32; the upper half of the range is taken for negative counts.
    """

    def __init__(self, first: int) -> None:
        self._last = first
        self.counts = first - _TURN if first >= _HALF else first

    def follow(self, reading: int) -> int:
        """The next reading, u32. Returns the count without wraps."""
        self.counts += (reading - self._last + _HALF) % _TURN - _HALF
        self._last = reading
        return self.counts


class Telemetry:
    """Asks, scales and keeps what was asked for last. Probes at once what the controller measures.

    Raises:
        DriveConnectionError: the encoder, the applied PWM or the status is not answered.
    """

    def __init__(self, link: Link, settings: RoboclawSettings, joint: JointScale) -> None:
        self._link, self._joint, self._motor = link, joint, settings.motor
        self._channel = commands.CHANNELS[settings.motor]
        self._index = self._channel.index
        self._is_signed = settings.current == "signed"
        self._slow_every = settings.slow_every
        self._encoder = EncoderCount(link.read(self._channel.encoder)[0])
        self._status, self._flags = _status_layout(link)
        self.faults: list[str] = []
        self._has_speed = settings.velocity == "drive" and _answers(link, self._channel.speed)
        self.has_current = _answers(link, commands.CURRENTS)
        self.has_supply = _answers(link, commands.SUPPLY)
        self.has_temperature = _answers(link, commands.TEMPERATURE)
        self._supply_v = self._temperature_c = nan
        self._supply_at_s = self._temperature_at_s = self._status_at_s = time.perf_counter()
        self._slow = self._slow_reads()
        self._cycle = 0
        for ask in self._slow:
            ask()
        self.quick: tuple[Read, ...] = self._quick_reads()

    @property
    def measured(self) -> frozenset[str]:
        """Names of the `Sample` fields that are measured."""
        optional = {
            "velocity_rad_s": self._has_speed,
            "current_a": self.has_current,
            "supply_v": self.has_supply,
            "temperature_c": self.has_temperature,
        }
        return frozenset({"time_s", "position_rad", "duty"} | {name for name, there in optional.items() if there})

    @property
    def resolution(self) -> dict[str, float]:
        """Smallest step of each quantity, in its unit."""
        steps = {
            "position_rad": self._joint.count_rad,
            "velocity_rad_s": self._joint.count_rad,
            "duty": 1.0 / DUTY_FULL,
            "current_a": CURRENT_A,
            "supply_v": _VOLTAGE_V,
            "temperature_c": _TEMPERATURE_C,
        }
        return {name: step for name, step in steps.items() if name in self.measured}

    def ask(self) -> tuple[list[tuple[int, ...]], list[float]]:
        """Ask for what is wanted in every cycle, in turn. Returns the data of `quick`, and when each was asked for [s].

        It was measured then or a little later: ages that come of it are not too small, however slow the line is.

        Raises:
            DriveConnectionError: no valid answer in time.
        """
        found, times_s = [], []
        for read in self.quick:
            times_s.append(time.perf_counter())
            found.append(self._link.read(read))
        return found, times_s

    def sample(self, status: Status, found: list[tuple[int, ...]], times_s: list[float]) -> Sample:
        """The sample of what was found; a slow question is asked where it is its turn, `faults` is up to date then.

        Raises:
            DriveConnectionError: no valid answer in time.
        """
        joint, has_speed, has_current = self._joint, self._has_speed, self.has_current
        self._ask_slow()
        position_rad = joint.position_rad(self._encoder.follow(found[0][0]))
        velocity_rad_s = joint.velocity_rad_s(_signed(*found[1])) if has_speed else nan
        place = 2 if has_speed else 1
        duty = joint.motor_sign * found[place][self._index] / DUTY_FULL
        current_a = self._current_a(found[place + 1][self._index], duty) if has_current else nan
        now_s = time.perf_counter()
        ages = Ages(
            now_s - times_s[0],
            now_s - times_s[1] if has_speed else 0.0,
            now_s - times_s[place],
            now_s - times_s[place + 1] if has_current else 0.0,
            now_s - self._supply_at_s if self.has_supply else 0.0,
            now_s - self._temperature_at_s if self.has_temperature else 0.0,
            now_s - self._status_at_s,
        )
        return Sample(
            times_s[0], ages.position_s, position_rad, velocity_rad_s, duty, current_a,
            self._supply_v, self._temperature_c, status, ages,
        )  # fmt: skip

    def read_status(self) -> list[str]:
        """Ask for the status now. Returns the faults, by name."""
        self.faults = faults(self._link.read(self._status)[0], self._flags, self._motor)
        self._status_at_s = time.perf_counter()
        return self.faults

    def read_output(self) -> tuple[float, float]:
        """Ask for the applied duty, -1 .. 1, and the motor current [A] now; NaN where that is not measured."""
        duty = self._joint.motor_sign * self._link.read(commands.APPLIED_DUTY)[self._index] / DUTY_FULL
        if not self.has_current:
            return duty, nan
        return duty, self._current_a(self._link.read(commands.CURRENTS)[self._index], duty)

    def _ask_slow(self) -> None:
        self._cycle += 1
        if self._cycle % self._slow_every == 0:
            self._slow[self._cycle // self._slow_every % len(self._slow)]()

    def _current_a(self, counts: int, duty: float) -> float:
        reported_a = counts * CURRENT_A
        if self._is_signed:
            return self._joint.motor_sign * reported_a
        return copysign(reported_a, duty) if reported_a else 0.0

    def _read_supply(self) -> None:
        self._supply_v = self._link.read(commands.SUPPLY)[0] * _VOLTAGE_V
        self._supply_at_s = time.perf_counter()

    def _read_temperature(self) -> None:
        self._temperature_c = self._link.read(commands.TEMPERATURE)[0] * _TEMPERATURE_C
        self._temperature_at_s = time.perf_counter()

    def _quick_reads(self) -> tuple[Read, ...]:
        """What is asked for in every cycle: encoder, speed where there is one, applied duty, currents likewise."""
        speed = (self._channel.speed,) if self._has_speed else ()
        currents = (commands.CURRENTS,) if self.has_current else ()
        return (self._channel.encoder, *speed, commands.APPLIED_DUTY, *currents)

    def _slow_reads(self) -> list[Callable[[], object]]:
        """The slow questions in turn; the status twice as often as the others."""
        others: list[Callable[[], object]] = []
        if self.has_supply:
            others.append(self._read_supply)
        if self.has_temperature:
            others.append(self._read_temperature)
        return [read for other in others for read in (self.read_status, other)] or [self.read_status]


def _signed(speed: int, direction: int) -> int:
    """A speed with its sign: some firmware gives the magnitude, and the direction in a byte of its own."""
    return -abs(speed) if direction & BACKWARD else speed


def _status_layout(link: Link) -> tuple[Read, tuple[Flag, ...]]:
    """The layout of the status word: four bytes, or two from older firmware. Each is tried twice, for a line may fail.

    Raises:
        DriveConnectionError: neither is answered.
    """
    layouts = ((commands.STATUS_32_BIT, FLAGS_32_BIT), (commands.STATUS_16_BIT, FLAGS_16_BIT))
    for layout in (*layouts, *layouts[:1]):
        if _answers(link, layout[0]):
            return layout
    link.begin()
    link.read(commands.STATUS_16_BIT)
    return layouts[1]


def _answers(link: Link, command: Read) -> bool:
    """Whether the controller knows a command; one that it does not know is met with silence."""
    try:
        link.begin()
        link.read(command)
    except DriveConnectionError:
        return False
    return True
