"""What a user says of the joint behind a device: its plant, by preset and tables, and its faults, by name."""

from collections.abc import Mapping
from typing import Any

from sim_backend.errors import ParameterError
from sim_backend.faults import script as faults
from sim_backend.faults.script import Fault
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.presets import by_name

# every drive that has a wire protocol measures its current and is warm
_DRIVE = {
    "current_sensor": {"present": True},
    "current_loop": {"present": True},
    "heat": {"present": True},
}


def behind_a_drive(
    preset: str = "paper", measured: Mapping[str, Any] | None = None, changed: Mapping[str, Any] | None = None
) -> PlantParameters:
    """Return a plant.

    Args:
        preset: of `presets`.
        measured: tables of what this kind of drive measures.
        changed: tables of what the user wants otherwise; they come last.

    Raises:
        ParameterError: the preset is unknown, or a table is impossible.
    """
    parameters = PlantParameters.from_dict(_DRIVE, base=by_name(preset))
    parameters = PlantParameters.from_dict(measured or {}, base=parameters)
    return PlantParameters.from_dict(changed or {}, base=parameters)


NAMES: dict[str, type[Fault]] = {
    "over-temperature": faults.OverTemperature,
    "over-current": faults.OverCurrent,
    "supply-lost": faults.SupplyLost,
    "drive-failed": faults.DriveFailed,
    "torque-disabled": faults.TorqueDisabled,
    "mode-refused": faults.ModeRefused,
    "encoder-stuck": faults.EncoderStuck,
    "encoder-jump": faults.EncoderJump,
    "samples-late": faults.SamplesLate,
    "clutch-slips": faults.ClutchSlips,
    "load-falls": faults.LoadFalls,
}


def fault_by_name(name: str, start_s: float, **values: Any) -> Fault:
    """Return a fault.

    Raises:
        ParameterError: the name or a value is not known or not possible.
    """
    if name not in NAMES:
        raise ParameterError(f"fault '{name}' is unknown; known are {', '.join(NAMES)}")
    try:
        return NAMES[name](start_s=start_s, **values)
    except TypeError as error:
        raise ParameterError(f"fault '{name}': {error}") from error
