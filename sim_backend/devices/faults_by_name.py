"""Faults of drive and joint by the name that a user types."""

from typing import Any

from sim_backend.errors import ParameterError
from sim_backend.faults import script as faults
from sim_backend.faults.script import Fault

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
