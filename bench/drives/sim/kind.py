"""The simulated drive as a kind."""

from collections.abc import Callable
from math import nan
from typing import TYPE_CHECKING

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.rig import Rig
from bench.config.validation import kind_of
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.errors import ConfigurationError
from drivers.contract import Drive

if TYPE_CHECKING:
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.environment.surroundings import Hand, Surroundings
    from sim_backend.faults.script import Fault


def make(settings: SimulatedDriveSettings, _rig: Rig) -> Drive:
    """The drive; its joint is that of the preset, not of the rig, as a real one is what it is.

    Raises:
        ConfigurationError: the plant is unknown or impossible.
    """
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.errors import ParameterError
    from sim_backend.plant.parameters import PlantParameters
    from sim_backend.plant.presets import by_name

    try:
        parameters = PlantParameters.from_dict(settings.plant, base=by_name(settings.preset))
        return SimulatedDrive(parameters, seed=settings.seed, faults=_script(settings))
    except ParameterError as error:
        raise ConfigurationError(f"simulated drive: {error}") from error


def _script(settings: SimulatedDriveSettings) -> "list[Fault]":
    """The faults of bench.toml as the simulation plays them."""
    from sim_backend.devices.joint_tables import NAMES
    from sim_backend.faults.script import FOR_GOOD_S, SamplesLost

    kinds: dict[str, Callable[..., Fault]] = {**NAMES, "samples-lost": SamplesLost}
    return [
        kinds[kind_of(type(fault))](
            start_s=fault.at_s,
            duration_s=fault.for_s or FOR_GOOD_S,
            by_the_wall=fault.clock == "wall",
            **fault.values(),
        )
        for fault in settings.faults
    ]


def wall_torque_n_m(drive: Drive) -> float:
    """Torque [N m] with which a wall or an end stop pushes the arm of a simulated joint; NaN of a real one."""
    from sim_backend.drive.simulated_drive import SimulatedDrive

    return drive.plant.truth().leant_n_m if isinstance(drive, SimulatedDrive) else nan


def beside_arm(drive: "SimulatedDrive") -> "tuple[Hand, Surroundings]":
    """The operator's hand on the arm of a simulated drive, and what that arm meets."""
    from sim_backend.environment.surroundings import Hand, Surroundings

    return Hand(drive.plant), Surroundings(drive.plant)


KIND = DriveKind(
    title="simulated drive",
    settings=SimulatedDriveSettings,
    make=make,
    beside_arm=beside_arm,
    conformance=(
        ConformanceBench("sim", settings={"plant": {"current_sensor": {"present": True}, "heat": {"present": True}}}),
    ),
)
