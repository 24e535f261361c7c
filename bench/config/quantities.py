"""Physical quantities in configurations and forms: the unit of a name, and fields that carry one.

A name ends in its unit (`speed_rad_s`). Forms, command-line help and error messages all show
the unit that this table gives.
"""

from drivers.settings import quantity as quantity

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
    "_g": "g",
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
