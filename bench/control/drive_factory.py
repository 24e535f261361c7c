"""The drive that the configuration names, and who hangs its load. The only file that knows the simulation."""

from collections.abc import Callable
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple

from bench.config.configuration import BenchConfiguration
from bench.config.drives.canopen import CanopenDriveSettings
from bench.config.drives.modbus import ModbusDriveSettings
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.roboclaw import RoboclawDriveSettings
from bench.config.drives.simulated import SimulatedDriveSettings
from bench.config.rig import Rig
from bench.control.technician import PersonTechnician, SimulatedTechnician, Technician
from bench.errors import ConfigurationError, ExperimentError
from drivers.contract import Drive

if TYPE_CHECKING:
    from sim_backend.environment.surroundings import Hand, Surroundings
    from sim_backend.faults.script import Fault

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

    Args:
        configuration: of the bench.
        ask: asks the person at a real drive.

    Raises:
        ConfigurationError: the simulated plant is unknown or impossible.
    """
    match configuration.drive:
        case SimulatedDriveSettings() as settings:
            return _simulated(settings)
        case RoboclawDriveSettings() as settings:
            return _roboclaw(settings, configuration.rig, ask)
        case ModbusDriveSettings() as settings:
            return _modbus(settings, configuration.rig, ask)
        case CanopenDriveSettings() as settings:
            return _canopen(settings, configuration.rig, ask)


def is_simulated(configuration: BenchConfiguration) -> bool:
    """Whether no hardware is behind the drive."""
    return configuration.drive.kind == "sim"


def has_hardware(configuration: BenchConfiguration) -> bool:
    """Whether what moves is real: neither the drive in this process nor a simulated device behind a real driver."""
    drive = configuration.drive
    return isinstance(drive, RealDriveSettings) and not drive.side_channel


def seed_of(configuration: BenchConfiguration) -> int | None:
    """Seed of a simulated drive; None for a real one."""
    match configuration.drive:
        case SimulatedDriveSettings(seed=seed):
            return seed
        case _:
            return None


def wall_torque_n_m(drive: Drive) -> float:
    """Torque [N m] with which a wall or an end stop pushes the arm of a simulated joint; NaN of a real one."""
    from sim_backend.drive.simulated_drive import SimulatedDrive

    return drive.plant.truth().leant_n_m if isinstance(drive, SimulatedDrive) else nan


def make_hand(drive: Drive) -> "Hand | None":
    """The operator's hand on the arm of a simulated drive; None at a real one, where a person stands."""
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.environment.surroundings import Hand

    return Hand(drive.plant) if isinstance(drive, SimulatedDrive) else None


def make_surroundings(drive: Drive) -> "Surroundings | None":
    """What the arm of a simulated drive meets; None at a real one."""
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.environment.surroundings import Surroundings

    return Surroundings(drive.plant) if isinstance(drive, SimulatedDrive) else None


# each imports what it needs by itself: a bench needs neither the libraries nor the compiler of another kind


def _simulated(settings: SimulatedDriveSettings) -> Equipment:
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.errors import ParameterError
    from sim_backend.plant.parameters import PlantParameters
    from sim_backend.plant.presets import by_name

    try:
        parameters = PlantParameters.from_dict(settings.plant, base=by_name(settings.preset))
        drive = SimulatedDrive(parameters, seed=settings.seed, faults=_script(settings))
    except ParameterError as error:
        raise ConfigurationError(f"simulated drive: {error}") from error
    return Equipment(drive, SimulatedTechnician(drive))


def _script(settings: SimulatedDriveSettings) -> "list[Fault]":
    """The faults of bench.toml as the simulation plays them; both name each kind alike."""
    from sim_backend.faults import script as faults

    return [
        getattr(faults, type(fault).__name__)(
            start_s=fault.at_s,
            duration_s=fault.for_s or faults.FOR_GOOD_S,
            by_the_wall=fault.clock == "wall",
            **fault.values(),
        )
        for fault in settings.faults
    ]


def _roboclaw(settings: RoboclawDriveSettings, rig: Rig, ask: Ask) -> Equipment:
    from drivers.roboclaw.drive import RoboclawDrive
    from drivers.roboclaw.settings import RoboclawSettings

    line = RoboclawSettings(**_driver_values(settings))
    return Equipment(RoboclawDrive(line, joint_scale(settings, rig)), _technician(settings, ask))


def _canopen(settings: CanopenDriveSettings, rig: Rig, ask: Ask) -> Equipment:
    from drivers.canopen import BusSettings, CanopenDrive, CanopenSettings
    from drivers.errors import DriveConfigurationError

    values = _driver_values(settings)
    bus = BusSettings(**{name: values.pop(name) for name in BusSettings.__match_args__})
    try:
        drive = CanopenDrive(CanopenSettings(bus=bus, **values), joint_scale(settings, rig))
    except DriveConfigurationError as error:
        raise ConfigurationError(str(error)) from error
    return Equipment(drive, _technician(settings, ask))


def _modbus(settings: ModbusDriveSettings, rig: Rig, ask: Ask) -> Equipment:
    from drivers.modbus.drive import ModbusDrive
    from drivers.modbus.map_file import MapError, load_map
    from drivers.modbus.settings import ModbusSettings

    if settings.transport == "tcp" and not settings.port.isdigit():
        raise ConfigurationError(f"drive.port is '{settings.port}'; with drive.transport = 'tcp' a number is wanted")
    try:
        register_map = load_map(settings.map)
    except MapError as error:
        raise ConfigurationError(f"drive.map: {error}") from error
    drive = ModbusDrive(ModbusSettings(**_driver_values(settings)), register_map, joint_scale(settings, rig))
    return Equipment(drive, _technician(settings, ask))


class _FarJoint:
    """A simulated device in another process, as far as loads go."""

    def __init__(self, side_channel: str) -> None:
        self._side_channel = side_channel

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load.

        Raises:
            ExperimentError: the device says no, or is not there.
        """
        from sim_backend.devices.side_channel import ask_once
        from sim_backend.errors import ParameterError

        try:
            ask_once(self._side_channel, "hang", load_kg=load_kg, balanced=balanced)
        except (ParameterError, OSError, ValueError) as error:
            raise ExperimentError(
                f"the load of {load_kg * 1000:g} g was not hung: drive.side_channel '{self._side_channel}': {error}; "
                "is the simulated device running, and is that what it printed?"
            ) from error


def _technician(settings: RealDriveSettings, ask: Ask) -> Technician:
    return SimulatedTechnician(_FarJoint(settings.side_channel)) if settings.side_channel else PersonTechnician(ask)


def _driver_values(settings: RealDriveSettings) -> dict[str, Any]:
    """What the driver's own settings take: all but the kind, and what the joint's scale takes."""
    return settings.model_dump(exclude={"kind", *RealDriveSettings.model_fields})
