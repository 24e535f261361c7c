"""The drive contract: what the bench may ask of any drive, real or simulated.

One exchange per control cycle: a command goes in, a sample comes out. Everything is SI and
is seen from the joint: the position is measured on the motor side, before the backlash, and
divided by the gear ratio. A quantity that the drive does not measure is NaN, never 0.

A drive is used by one thread at a time. While it is disabled any time may pass between two
calls: a person hangs a load, and the watchdog must not mind. While it is enabled it stops by
itself where no command comes for `Description.watchdog_s`; one that has no watchdog says so, and nobody runs it
unknowingly.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum, StrEnum
from math import nan
from typing import NamedTuple, Protocol, runtime_checkable


class Mode(Enum):
    """What the command value means."""

    OFF = "off"  # power stage off; the value is ignored
    DUTY = "duty"  # signed PWM duty, -1 .. 1 of the supply
    CURRENT = "current"  # motor current [A]
    TORQUE = "torque"  # torque at the motor side of the joint's gear [N m]
    POSITION = "position"  # joint position [rad], closed by the drive itself
    HOME = "home"  # 1: the drive looks for its home position by itself, and counts from there; 0: it holds the joint


class Status(IntEnum):
    """State of the power stage, after CiA 402."""

    DISABLED = 0
    ENABLED = 1
    QUICK_STOP = 2
    FAULT = 3


class Watchdog(StrEnum):
    """How sure it is that the drive stops by itself where its host falls silent."""

    PROVEN = "proven"  # it was seen: a demand, silence, and then no output, before anything else was written
    CONFIGURED = "configured, not proven"  # set and read back, or vouched for by whoever set it in the drive
    NONE = "none"  # the drive has nothing that guards against it


class Command(NamedTuple):
    """One cycle's demand. The unit of the value follows the mode.

    Attributes:
        feed_forward_a: in POSITION, motor current that the drive adds to what its own position loop asks for [A]:
            where friction is compensated. Other modes ignore it.
    """

    mode: Mode
    value: float = 0.0
    feed_forward_a: float = 0.0


class Ages(NamedTuple):
    """How old each quantity of a sample is when it is handed over [s]; 0 where it is not measured.

    Drives on a slow line ask for what changes slowly less often than once per cycle.
    """

    position_s: float = 0.0
    velocity_s: float = 0.0
    duty_s: float = 0.0
    current_s: float = 0.0
    supply_s: float = 0.0
    temperature_s: float = 0.0
    status_s: float = 0.0


ALL_NEW = Ages()


class Sample(NamedTuple):
    """One cycle's measurement, SI, joint side.

    Attributes:
        time_s: when the position was measured [s], by the drive's own clock where it tells the time, else the
            host's; monotonic, arbitrary origin.
        age_s: age of the oldest of position, velocity, duty and current [s]: what the control loop acts on.
        position_rad: motor-side position / gear ratio [rad]; 0 is vertically down.
        velocity_rad_s: motor-side speed / gear ratio [rad/s].
        duty: PWM duty applied, -1 .. 1.
        current_a: motor current measured by the drive [A]; NaN without a sensor.
        supply_v: supply voltage [V].
        temperature_c: temperature that the drive reports [deg C].
        ages: of each quantity.
        number: of the measurement since opening, where the drive is asked for each (CANopen: of the SYNC); two
            samples of one number are one measurement, handed over twice because the next one has not come in time.
        torque_n_m: torque that the drive says it gives, at the motor side of the joint's gear [N m]; NaN where it
            says nothing of it.
        homed: in HOME, whether the drive has found its home position; its positions count from there then.
    """

    time_s: float
    age_s: float
    position_rad: float
    velocity_rad_s: float
    duty: float
    current_a: float
    supply_v: float
    temperature_c: float
    status: Status
    ages: Ages = ALL_NEW
    number: int = 0
    torque_n_m: float = nan
    homed: bool = False


@dataclass(frozen=True, slots=True)
class Inspection:
    """What a drive says of itself while nothing is written to it.

    Attributes:
        status: of the power stage, by the drive's own word; None where it has none for it.
        fault: in words; "" where it reports none.
        duty: applied PWM duty, -1 .. 1; NaN where it is not measured.
        current_a: motor current [A]; NaN where it is not measured.
        torque_off: what says that safe torque off (STO) is active, in words: no power, and no fault; "" where it is
            not, or the drive does not tell.
    """

    status: Status | None
    fault: str = ""
    duty: float = nan
    current_a: float = nan
    torque_off: str = ""


@dataclass(frozen=True, slots=True)
class FoundTable:
    """What was found at connect, for a person to look through.

    Attributes:
        rows: one text a column.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Untold:
    """A fact that neither drive nor settings tell, and for want of which its effort is unknown.

    Attributes:
        remedy: what is missing and what to set, in words, as the end of a sentence.
        tells: with it, the drive measures its current.
        takes: with it, the drive can be asked for a current.
    """

    remedy: str
    tells: bool
    takes: bool


@dataclass(frozen=True, slots=True)
class OwnLimit:
    """The motor current that a drive allows by itself, as somebody has set it there.

    Attributes:
        current_a: the most that flows [A]; 0 where the drive may not move the motor at all.
        words: the limit, and which setting of `[drive]` changes it; a sentence.
    """

    current_a: float
    words: str


@dataclass(frozen=True, slots=True)
class Description:
    """Identity and capabilities of a drive, as found at connect.

    Attributes:
        vendor, product, firmware, serial: identity; empty where the drive does not tell.
        simulated: True where no hardware is behind it, by what the device says of itself.
        modes: the modes that the drive closes itself.
        measured: the names of the `Sample` fields that are measured (others are NaN).
        resolution: smallest step of a quantity, by `Sample` field name, in its unit.
        max_rate_hz: highest cycle rate that the drive sustains [Hz].
        watchdog_s: time after the last command at which the drive stops by itself [s]; None where nothing stops it.
        longest_call_s: by then every call has returned or raised [s]; opening may take `longest_open_s`.
        watchdog: how sure it is that the drive stops by itself then.
        notes: what the user should know of line and host, and what to do; a sentence each.
        tables: what was found beside, in the drive's own terms.
        counts_per_turn: encoder counts of a motor turn by the drive's own objects; NaN where it tells none.
        untold: what has to be set before the drive can be used in full; None where nothing is.
        own_limit: of the motor current; None where the drive tells none, or the configuration has set it.
    """

    device: str
    vendor: str
    product: str
    firmware: str
    serial: str
    simulated: bool
    modes: frozenset[Mode]
    measured: frozenset[str]
    resolution: dict[str, float]
    max_rate_hz: float
    watchdog_s: float | None
    longest_call_s: float = 0.0
    longest_open_s: float = 0.0
    watchdog: Watchdog = Watchdog.CONFIGURED
    notes: tuple[str, ...] = ()
    tables: tuple[FoundTable, ...] = ()
    counts_per_turn: float = nan
    untold: Untold | None = None
    own_limit: OwnLimit | None = None


class Drive(Protocol):
    """A servo drive with one joint on it. Every call returns in bounded time or raises `DriveError`."""

    def describe(self) -> Description:
        """Identity and capabilities. Complete once open."""

    def open(self, period_s: float) -> None:
        """Connect, set the watchdog and verify it. The power stage stays off.

        Args:
            period_s: control period at which `exchange` will be called [s].

        Raises:
            DriveConnectionError: the port is not there, or nothing answers on it.
            DriveConfigurationError: what answers is not the drive that was configured.
            WatchdogError: the watchdog cannot be set.
        """

    def close(self) -> None:
        """Power off and disconnect. Safe to call twice, and from any state."""

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand; in POSITION that is the present position.

        Raises:
            DriveConfigurationError: the drive does not have the mode.
            DriveStateError: it is not open, has a fault, or does not switch on.
        """

    def disable(self) -> None:
        """Power off. Safe to call in any state of an open drive."""

    def quick_stop(self) -> None:
        """Brake as fast as the drive can, then power off."""

    def inspect(self) -> Inspection:
        """Ask for state, fault and applied output, and write nothing; a watchdog that ran out stays as it is.

        Raises:
            DriveStateError: it is not open.
            DriveConnectionError: no valid answer within the time limit.
        """

    def clear_fault(self) -> None:
        """Acknowledge a fault; `inspect` says which. The drive is left disabled.

        Raises:
            DriveFault: the cause is still there, and so is the fault.
        """

    def exchange(self, command: Command) -> Sample:
        """Send one command and return the sample of this cycle.

        Raises:
            DriveFault: the drive has switched itself off, or its watchdog has.
            DriveStateError: motion was commanded in a mode that is not enabled.
            DriveConfigurationError: the command is not finite or outside the drive's range; nothing was sent.
            DriveConnectionError: no valid answer within the time limit.
        """


@runtime_checkable
class BusDrive(Drive, Protocol):
    """A drive on a bus that asks several of its drives in one exchange."""

    @property
    def bus(self) -> object | None:
        """The bus that it shares; None while it is not open."""

    def exchange_together(self, commands: Sequence[tuple[Drive, Command]]) -> list[Sample]:
        """Send a command to each of some open drives on its bus, and return their samples in that order.

        Raises:
            DriveError: as `exchange`; where one does not answer, all of them are told to be off.
        """


@runtime_checkable
class BrakeOutput(Protocol):
    """A drive with an output for the holding brake, which whoever uses it sets and releases."""

    def set_brake(self, released: bool, confirmed: bool = True) -> None:
        """Release or set the brake.

        Args:
            released: with current in its coil.
            confirmed: wait for the drive's answer; else send it at once and wait for nothing.

        Raises:
            DriveConfigurationError: no output was configured.
            DriveStateError: the drive is not open.
            DriveConnectionError: it does not confirm it.
        """


@runtime_checkable
class OwnBrake(Protocol):
    """A drive that sets a brake of its own while it still holds the joint, and then takes its power away."""

    def stand_down(self, engage_s: float) -> None:
        """Have it do so; the power is off afterwards, whatever came of it.

        Args:
            engage_s: time that its brake takes [s].

        Raises:
            DriveStateError: the drive is not open.
            DriveConnectionError: it does not answer.
        """


@runtime_checkable
class OwnRamp(Protocol):
    """A drive that brakes on a ramp of its own where it stops by itself; when it is opened, it sees that this is short.

    Attributes:
        highest_speed_rad_s: of the joint, from which it has to stop [rad/s].
    """

    highest_speed_rad_s: float
