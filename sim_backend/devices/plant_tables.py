"""The plant behind a device: a preset, what a drive of its kind measures of it, and what the user wants otherwise."""

from collections.abc import Mapping
from typing import Any

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
