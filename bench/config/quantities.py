"""Physical quantities in configurations and forms: the unit of a name, and fields that carry one.

A name ends in its unit (`speed_rad_s`). Forms, command-line help and error messages all show
the unit that this table gives.
"""

from typing import Any

from pydantic import Field

UNITS: dict[str, str] = {  # the longest ending wins
    "_a_s2_rad": "A s2/rad",
    "_a_s_rad": "A s/rad",
    "_a_rad_s": "A/(rad s)",
    "_a_rad": "A/rad",
    "_a_s": "A/s",
    "_n_m_a": "N m/A",
    "_v_s_rad": "V s/rad",
    "_kg_m2": "kg m2",
    "_rad_s2": "rad/s2",
    "_rad_s": "rad/s",
    "_n_m_rad": "N m/rad",
    "_n_m": "N m",
    "_m_s": "m/s",
    "_per_turn": "1/turn",
    "_ohm": "ohm",
    "_rad": "rad",
    "_hz": "Hz",
    "_kg": "kg",
    "_s": "s",
    "_m": "m",
    "_n": "N",
    "_a": "A",
    "_v": "V",
    "_h": "H",
    "_c": "degC",
    "_cycles": "cycles",
}
_LONGEST_FIRST = sorted(UNITS, key=len, reverse=True)


def unit_of(name: str) -> str:
    """The unit that a name ends in; "" where it has none."""
    return next((UNITS[ending] for ending in _LONGEST_FIRST if name.endswith(ending)), "")


def quantity(default: Any, unit: str, description: str, **constraints: Any) -> Any:
    """A pydantic field with a unit; `...` as default makes it required.

    Args:
        default: SI value.
        unit: shown beside the value; "" for a number or a name.
        description: one line for forms and help.
        constraints: `ge`, `le`, `gt`, `lt`, `min_length`, `max_length` ..., as for `pydantic.Field`.
    """
    return Field(default, description=description, json_schema_extra={"unit": unit}, **constraints)
