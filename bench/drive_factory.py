"""The drive that the configuration names, and who hangs its load. The only file that knows the simulation."""

from typing import NamedTuple

from bench.configuration import BenchConfiguration, SimulatedDriveSettings
from bench.errors import ConfigurationError
from bench.technician import SimulatedTechnician, Technician
from drivers.contract import Drive


class Equipment(NamedTuple):
    """What stands on the bench."""

    drive: Drive
    technician: Technician


def make_equipment(configuration: BenchConfiguration) -> Equipment:
    """The drive, not yet open, and the technician.

    Raises:
        ConfigurationError: the simulated plant is unknown or impossible.
    """
    return _simulated(configuration.drive)


def is_simulated(configuration: BenchConfiguration) -> bool:
    """Whether no hardware is behind the drive."""
    return configuration.drive.kind == "sim"


def _simulated(settings: SimulatedDriveSettings) -> Equipment:
    # imported here: a bench with a real drive needs neither the physics nor its compiler
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
