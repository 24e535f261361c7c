"""The simulated drive as a kind."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.rig import Rig
from bench.drives.sim import faults as settings_of
from bench.drives.sim.faults import FaultSettings
from bench.drives.sim.joint import beside_arm
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.errors import ConfigurationError
from drivers.contract import Drive

if TYPE_CHECKING:
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
    from sim_backend.faults import script as faults

    kinds: dict[type[FaultSettings], Callable[..., Fault]] = {
        settings_of.EncoderStuck: faults.EncoderStuck,
        settings_of.EncoderJump: faults.EncoderJump,
        settings_of.SamplesLost: faults.SamplesLost,
        settings_of.SamplesLate: faults.SamplesLate,
        settings_of.OverTemperature: faults.OverTemperature,
        settings_of.OverCurrent: faults.OverCurrent,
        settings_of.SupplyLost: faults.SupplyLost,
        settings_of.DriveFailed: faults.DriveFailed,
        settings_of.TorqueDisabled: faults.TorqueDisabled,
        settings_of.ClutchSlips: faults.ClutchSlips,
        settings_of.LoadFalls: faults.LoadFalls,
    }
    return [
        kinds[type(fault)](
            start_s=fault.at_s,
            duration_s=fault.for_s or faults.FOR_GOOD_S,
            by_the_wall=fault.clock == "wall",
            **fault.values(),
        )
        for fault in settings.faults
    ]


KIND = DriveKind(
    title="simulated drive",
    settings=SimulatedDriveSettings,
    make=make,
    beside_arm=beside_arm,
    conformance=(
        ConformanceBench("sim", settings={"plant": {"current_sensor": {"present": True}, "heat": {"present": True}}}),
    ),
)
