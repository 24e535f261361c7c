"""The conditions of a trial: which ones are known, in which unit, and what they can be."""

from compensator.lab.recordings.recording import Condition

KNOWN: dict[str, str] = {"load_kg": "kg", "arm_m": "m", "session_s": "s", "repeat": "", "balanced": "", "waveform": ""}
"""Those that the model lab reads and a column of a log can tell, with their SI unit; "" where they have none."""
TEXTS = ("waveform", "recorded_by")
"""Those that are text."""
FLAGS = ("balanced",)
RESERVED = ("file", "name", "kind", "rows")
"""Columns of trials.csv that are no conditions."""
_NOT_BELOW_0 = ("load_kg", "arm_m")
# a name with another unit -> (the name that is known, factor)
OTHER_UNITS = {
    "load_g": ("load_kg", 1e-3),
    "load_lb": ("load_kg", 0.45359237),
    "load_oz": ("load_kg", 0.028349523125),
    "arm_cm": ("arm_m", 1e-2),
    "arm_mm": ("arm_m", 1e-3),
}


def condition_problem(name: str, value: Condition) -> str | None:
    """What is wrong with a condition, what is wanted, and what to do; None where nothing is."""
    lower = name.lower()
    if lower in OTHER_UNITS:
        known, factor = OTHER_UNITS[lower]
        entry = f'trials_columns.{known} = {{ from = "{name}", scale = {factor:.10g} }}'
        return f"is not in SI; {known} is known. Convert with a mapping: {entry}"
    if name in _NOT_BELOW_0 and (isinstance(value, (bool, str)) or value < 0):
        found = f"'{value}'" if isinstance(value, (bool, str)) else f"{value:g}"
        return f"found {found}; wanted a number of 0 or more [{KNOWN[name]}], or nothing where it is not known"
    if name in FLAGS and not isinstance(value, bool) and value not in (0.0, 1.0):
        return f"found '{value}'; wanted true or false, or nothing where it is not known"
    return None
