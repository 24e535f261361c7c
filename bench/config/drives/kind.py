"""What a kind of drive brings in: settings, driver, simulated device, and how the conformance tests set it up."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, Literal, Protocol, TypeVar

from bench.config.drives.scanning import CanScan, SerialScan
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig, Section
from bench.config.validation import kind_of
from drivers.contract import Drive, Mode
from drivers.follower import Follower


class BrakeSettings(Section):
    """A brake that holds the joint while the drive has no power. Spring-applied: without current it is set."""

    by: Literal["none", "drive", "output"] = quantity(
        "none",
        "",
        "Who sets and releases it: 'drive', by itself with its power stage; 'output', this bench by an output of the "
        "drive; 'none': there is none",
    )
    release_s: float = quantity(
        0.1, "s", "From the word to release it until the joint is free, by its data sheet", gt=0, le=5
    )
    engage_s: float = quantity(0.1, "s", "From the word to set it until it holds, by its data sheet", gt=0, le=5)
    move_rad: float = quantity(
        0.02, "rad", "Farthest that the joint may move while the brake is set, and while it is released or set", gt=0
    )
    output_bit: int = quantity(
        0, "", "Bit of the output: of 0x60FE, where CiA 402 has 'set brake' as bit 0", ge=0, le=31
    )
    set_level: Literal[0, 1] = quantity(1, "", "That bit while the brake is set")


class DriveSettings(Section):
    """A `[drive]` section. Those of a drive on a wire derive from `RealDriveSettings`.

    A kind whose settings do not is simulated in this process: its time is virtual, and it has `hang_load`.
    """

    kind: str
    brake: BrakeSettings = BrakeSettings()


@dataclass(frozen=True)
class ConformanceBench:
    """One way to run the conformance tests (`tests/drivers/conformance`) on a kind.

    Attributes:
        name: in the names of the tests.
        device: options of `friction-bench simulate-device KIND`.
        settings: keys of `[drive]`, beside those that the simulated device prints; short time limits do not fit a
            busy test machine.
        has_link: whether the device takes `--link`, so that its port comes back under the same name.
        wrong_address: the key of `[drive]` and the address at which nobody answers.
        refused_mode: a mode that it lacks, or that it can be made to refuse in motion.
        is_checked: whether a flipped bit is seen in every packet; None: the transport never flips one.
        knows_counts: whether it knows its encoder, and refuses a rig that says otherwise; None: its position needs
            no counts, for it is told in turns.
        has_watchdog: whether it stops by itself when its host falls silent.
        tells_firmware: whether it says which version runs in it.
    """

    name: str
    device: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    has_link: bool = True
    wrong_address: tuple[str, int] = ("", 0)
    refused_mode: Mode = Mode.POSITION
    is_checked: bool | None = True
    knows_counts: bool | None = False
    has_watchdog: bool = True
    tells_firmware: bool = True


class Hand(Protocol):
    """The operator at the master."""

    def take_hold(self) -> None:
        """Hold the arm where it is."""

    def reach(self, angle_rad: float, duration_s: float) -> None:
        """Reach for an angle, beginning now."""

    def torque_n_m(self) -> float:
        """What the hand does to the arm; NaN where nobody knows."""


class Environment(Protocol):
    """What the slave's arm meets."""

    def put_wall(self, angle_rad: float | None) -> None:
        """Have a wall at an angle, or none."""

    def interaction_n_m(self) -> float:
        """Torque that load and wall truly take; NaN where nobody knows."""


SettingsT = TypeVar("SettingsT", bound=DriveSettings)


@dataclass(frozen=True)
class DriveKind(Generic[SettingsT]):
    """A kind of drive. Its functions import what they need themselves: a bench needs no library of another kind.

    Attributes:
        settings: the `[drive]` section; its `kind` is a `Literal` with the name of the kind.
        make: makes the drive, not yet open, of the section and the rig. Raises `ConfigurationError`.
        simulate: imports the function behind `friction-bench simulate-device KIND`; None where there is no device.
        conformance: how the conformance tests run on it.
        scan_serial, scan_can: say which drives of the kind answer on a port or a bus.
        share: lets drives of one bench that are on one line use it together, before they are opened; raises
            `ConfigurationError`. None: each has a line of its own.
        follow: looks at one that another program moves: of the section, the rig, the name of the port that it offers,
            and the time from one look to the next [s]. None: that cannot be done.
        beside_arm: makes the operator's hand on the arm of a drive, and what that arm meets. None: a person does it.
    """

    title: str
    settings: type[SettingsT]
    make: Callable[[SettingsT, Rig], Drive]
    simulate: Callable[[], Simulate] | None = None
    conformance: tuple[ConformanceBench, ...] = ()
    scan_serial: SerialScan | None = None
    scan_can: CanScan | None = None
    share: Callable[[Sequence[Any]], None] | None = None
    follow: Callable[[SettingsT, Rig, Path, float], Follower] | None = None
    beside_arm: Callable[[Any], tuple[Hand, Environment]] | None = None

    @property
    def name(self) -> str:
        """What `kind` in `[drive]` says."""
        return kind_of(self.settings)
