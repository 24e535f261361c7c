"""What may go wrong on a bench, scripted in the drive's own time or by the wall clock."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from time import monotonic
from typing import TypeVar

from sim_backend.errors import ParameterError
from sim_backend.plant.component import Component, quantity

FOR_GOOD_S = 1e12


@dataclass(frozen=True, kw_only=True)
class Fault(Component):
    """Something that is wrong from a time on, for a while or for good."""

    start_s: float = quantity("s, since the drive was made", at_least=0)
    duration_s: float = quantity("s", above=0, default=FOR_GOOD_S)
    by_the_wall: bool = False  # seconds of the wall clock, not the drive's own

    def holds(self, time_s: float) -> bool:
        """Tell whether it is wrong at a time."""
        # a drive's time is a sum of periods: half a nanosecond is rounding
        return -5e-10 <= time_s - self.start_s < self.duration_s - 5e-10


class EncoderStuck(Fault):
    """The encoder shows the position of the start, whatever the motor does."""


@dataclass(frozen=True, kw_only=True)
class EncoderJump(Fault):
    """The encoder has lost counts: every position is off by so much, and the speed is wrong while that is news."""

    jump_rad: float = quantity("rad at the joint")


class SamplesLost(Fault):
    """Neither command nor sample gets through. The drive goes on with the last command until its watchdog acts."""


@dataclass(frozen=True, kw_only=True)
class SamplesLate(Fault):
    """What the drive measures arrives late; the age in the sample says so."""

    age_s: float = quantity("s", above=0, at_most=1)


class ModeRefused(Fault):
    """The drive takes no other mode than the one it is in."""


class Trip(Fault, ABC):
    """The drive switches itself off, and cannot be cleared while the cause is there."""

    @abstractmethod
    def cause(self) -> str:
        """Say what the drive reports."""


@dataclass(frozen=True, kw_only=True)
class OverTemperature(Trip):
    """The drive is too hot, and says how hot where it measures that."""

    temperature_c: float = quantity("degC", above=0, default=95.0)

    def cause(self) -> str:
        """Say what the drive reports."""
        return f"over-temperature, {self.temperature_c:g} degC"


@dataclass(frozen=True, kw_only=True)
class OverCurrent(Trip):
    """The stage has seen a current spike: a short, a jammed motor."""

    current_a: float = quantity("A", above=0, default=20.0)

    def cause(self) -> str:
        """Say what the drive reports."""
        return f"over-current, {self.current_a:g} A"


class SupplyLost(Trip):
    """The supply of the power stage is gone; the drive's logic lives on."""

    def cause(self) -> str:
        """Say what the drive reports."""
        return "under-voltage, 0 V at the power stage"


@dataclass(frozen=True, kw_only=True)
class DriveFailed(Trip):
    """Any other fault of the drive's own."""

    text: str = "internal fault"

    def cause(self) -> str:
        """Say what the drive reports."""
        return self.text


class TorqueDisabled(Fault):
    """Somebody has opened the safe-torque-off circuit: no fault, and no power."""


@dataclass(frozen=True, kw_only=True)
class ClutchSlips(Fault):
    """The coupling between transmission and arm holds no more than this."""

    limit_n_m: float = quantity("N m", above=0)


class LoadFalls(Fault):
    """The load falls off the arm. It does not come back by itself."""


Kind = TypeVar("Kind", bound=Fault)


class FaultScript:
    """The faults of a run, in any order. Two of a kind may not overlap. For those by the wall clock it begins now.

    Raises:
        ParameterError: two of a kind overlap.
    """

    def __init__(self, faults: Iterable[Fault] = ()) -> None:
        self._origin_s = monotonic()
        self.faults: list[Fault] = []
        for fault in sorted(faults, key=lambda one: one.start_s):
            self.add(fault)

    def add(self, fault: Fault) -> None:
        """Let something more go wrong.

        Raises:
            ParameterError: another of the kind is there at a time when this one is.
        """
        for other in self.faults:
            first, second = sorted((other, fault), key=lambda one: one.start_s)
            alike = type(other) is type(fault) and other.by_the_wall == fault.by_the_wall
            if alike and first.holds(second.start_s):
                raise ParameterError(
                    f"{type(fault).__name__}.start_s = {second.start_s:g} [s]: the one of {first.start_s:g} s is "
                    f"not over before {first.start_s + first.duration_s:g} s; one of a kind at a time"
                )
        self.faults.append(fault)
        self.faults.sort(key=lambda one: one.start_s)

    def lift(self, time_s: float) -> None:
        """Put right whatever is wrong at a time; what is to come stays."""
        self.faults = [fault for fault in self.faults if not fault.holds(self.time_of(fault, time_s))]

    def __bool__(self) -> bool:
        return bool(self.faults)

    def holding(self, kind: type[Kind], time_s: float) -> Kind | None:
        """Return the fault of a kind that is there at a time, or None."""
        for fault in self.faults:
            if isinstance(fault, kind) and fault.holds(self.time_of(fault, time_s)):
                return fault
        return None

    def time_of(self, fault: Fault, time_s: float) -> float:
        """Return the time by which a fault goes [s]: the drive's, as given, or the wall clock's."""
        return monotonic() - self._origin_s if fault.by_the_wall else time_s

    def trip(self, time_s: float) -> Trip | None:
        """Return what switches the drive off at a time, or None."""
        return self.holding(Trip, time_s)  # type: ignore[type-abstract]


def tripped(cause: Trip | None, hot: int, over_current: int, under_voltage: int, other: int) -> int:
    """The error of a cause, of those that a kind has; a supply that a hand has cut is a voltage that is too low."""
    if isinstance(cause, OverTemperature):
        return hot
    if isinstance(cause, OverCurrent):
        return over_current
    return under_voltage if cause is None or isinstance(cause, SupplyLost) else other
