"""The drive that the configuration names, and who hangs its load."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from bench.config.configuration import BenchConfiguration
from bench.config.drives.real import RealDriveSettings
from bench.config.drives.registry import drive_kind
from bench.control.technician import PersonTechnician, SimulatedTechnician, Technician
from bench.drives.far_joint import FarJoint
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.errors import ConfigurationError
from drivers.contract import Drive, OwnRamp

Ask = Callable[[str], bool]
"""Shows a sentence to the person at the bench; returns True when it is done, False when the person gives up."""


class Equipment(NamedTuple):
    """What stands on the bench."""

    drive: Drive
    technician: Technician


def nobody(sentence: str) -> bool:
    """An `Ask` where no person is at hand.

    Raises:
        ConfigurationError: always.
    """
    raise ConfigurationError(f"a person is needed, and there is none to ask: {sentence}")


def make_equipment(configuration: BenchConfiguration, ask: Ask = nobody) -> Equipment:
    """The drive, not yet open, and the technician.

    Raises:
        ConfigurationError: the section cannot be used; the message says why.
    """
    settings = configuration.drive
    drive: Drive = drive_kind(settings.kind).make(settings, configuration.rig)
    if isinstance(drive, OwnRamp):
        drive.highest_speed_rad_s = configuration.limits.speed_rad_s
    if isinstance(settings, RealDriveSettings):
        return Equipment(drive, _technician(settings, ask))
    if not isinstance(drive, Technician):
        raise ConfigurationError(
            f"drive kind '{settings.kind}' is simulated in this process, and its drive has no hang_load; its author "
            "has to add it, or to derive its settings from RealDriveSettings"
        )
    return Equipment(drive, SimulatedTechnician(drive))


def share_lines(drives: Iterable[tuple[BenchConfiguration, Drive]]) -> None:
    """Let drives of one bench that are on one line use it together, where their kind can. Before any is opened.

    Raises:
        ConfigurationError: they cannot be on one line.
    """
    by_kind: dict[str, list[Drive]] = {}
    for bench, drive in drives:
        by_kind.setdefault(bench.drive.kind, []).append(drive)
    for kind, alike in by_kind.items():
        share = drive_kind(kind).share
        if share is not None:
            share(alike)


def is_simulated(configuration: BenchConfiguration) -> bool:
    """Whether drive and joint are in this process, and time is virtual."""
    return not isinstance(configuration.drive, RealDriveSettings)


def has_hardware(configuration: BenchConfiguration) -> bool:
    """Whether what moves is real: neither the drive in this process nor a simulated device behind a real driver."""
    drive = configuration.drive
    return isinstance(drive, RealDriveSettings) and not drive.side_channel


def seed_of(configuration: BenchConfiguration) -> int | None:
    """Seed of a simulated drive; None for a real one."""
    drive = configuration.drive
    return drive.seed if isinstance(drive, SimulatedDriveSettings) else None


def with_seed(configuration: BenchConfiguration, seed: int) -> BenchConfiguration:
    """The same bench, with another seed of its simulated drive."""
    return configuration.model_copy(update={"drive": configuration.drive.model_copy(update={"seed": seed})})


def _technician(settings: RealDriveSettings, ask: Ask) -> Technician:
    return SimulatedTechnician(FarJoint(settings.side_channel)) if settings.side_channel else PersonTechnician(ask)
