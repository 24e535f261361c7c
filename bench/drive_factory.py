"""The drive that the configuration names, and who hangs its load. The only file that knows the simulation."""

from collections.abc import Callable
from typing import NamedTuple

from bench.configuration import BenchConfiguration
from bench.drives.simulated import SimulatedDriveSettings
from bench.errors import ConfigurationError
from bench.technician import SimulatedTechnician, Technician
from drivers.contract import Drive

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


def make_equipment(configuration: BenchConfiguration, ask: Ask = nobody) -> Equipment:  # noqa: ARG001
    """The drive, not yet open, and the technician.

    Args:
        configuration: of the bench.
        ask: asks the person at a real drive.

    Raises:
        ConfigurationError: the simulated plant is unknown or impossible.
    """
    match configuration.drive:
        case SimulatedDriveSettings() as settings:
            return _simulated(settings)


def is_simulated(configuration: BenchConfiguration) -> bool:
    """Whether no hardware is behind the drive."""
    return configuration.drive.kind == "sim"


def seed_of(configuration: BenchConfiguration) -> int | None:
    """Seed of a simulated drive; None for a real one."""
    match configuration.drive:
        case SimulatedDriveSettings(seed=seed):
            return seed


# each imports what it needs by itself: a bench needs neither the libraries nor the compiler of another kind


def _simulated(settings: SimulatedDriveSettings) -> Equipment:
    from sim_backend.drive import SimulatedDrive
    from sim_backend.errors import ParameterError
    from sim_backend.parameters import PlantParameters
    from sim_backend.presets import by_name

    try:
        parameters = PlantParameters.from_dict(settings.plant, base=by_name(settings.preset))
        drive = SimulatedDrive(parameters, seed=settings.seed)
    except ParameterError as error:
        raise ConfigurationError(f"simulated drive: {error}") from error
    return Equipment(drive, SimulatedTechnician(drive))
