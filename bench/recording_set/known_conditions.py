"""Conditions that the model lab reads as physics: a wrong one would be taken for nothing hung, or for balanced."""

from compensator.lab.recordings.recording import Condition

_QUANTITIES = {"load_kg": "kg", "arm_m": "m"}
_FLAGS = ("balanced",)
# a name with another unit -> (the name that is known, factor)
_OTHER_UNITS = {
    "load_g": ("load_kg", 1e-3),
    "load_lb": ("load_kg", 0.45359237),
    "load_oz": ("load_kg", 0.028349523125),
    "arm_cm": ("arm_m", 1e-2),
    "arm_mm": ("arm_m", 1e-3),
}


def problem(name: str, value: Condition) -> str | None:
    """What is wrong with a condition, what is wanted, and what to do; None where nothing is."""
    lower = name.lower()
    if lower in _OTHER_UNITS:
        known, factor = _OTHER_UNITS[lower]
        entry = f'trials_columns.{known} = {{ from = "{name}", scale = {factor:.10g} }}'
        return f"is not in SI; {known} is known. Convert with a mapping: {entry}"
    if name in _QUANTITIES and (isinstance(value, (bool, str)) or value < 0):
        found = f"'{value}'" if isinstance(value, (bool, str)) else f"{value:g}"
        return f"found {found}; wanted a number of 0 or more [{_QUANTITIES[name]}], or nothing where it is not known"
    if name in _FLAGS and not isinstance(value, bool) and value not in (0.0, 1.0):
        return f"found '{value}'; wanted true or false, or nothing where it is not known"
    return None
