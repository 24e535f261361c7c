"""What a user says of a column: `NAME=QUANTITY[UNIT]`, such as `pos=position[deg]` or `mark=ignore`.

A magnitude takes its sign from another column: `i=current[A] by duty`.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.guess.names import UNITS_OF
from bench.recording_set.mapping import STAMP
from bench.recording_set.units import unit_named, units_of

IGNORE = "ignore"
_FORM = re.compile(r"(?P<name>.+)=(?P<quantity>[a-z_]+)(?:\[(?P<unit>[^\]]+)\])?(?: by (?P<sign>.+))?")
_OPTION = "--take"


@dataclass(frozen=True)
class Said:
    """What a user says of a column.

    Attributes:
        column: its name.
        quantity: or IGNORE.
        unit: None where none is said.
        sign_from: column whose sign it takes, where it is a magnitude.
    """

    column: str
    quantity: str
    unit: str | None
    sign_from: str | None = None


def read_said(texts: Sequence[str]) -> dict[str, Said]:
    """What was said, by column.

    Raises:
        RecordingSetError: not of that form, an unknown quantity or unit.
    """
    return {one.column: one for one in map(_read, texts)}


def _read(text: str) -> Said:
    match = _FORM.fullmatch(text.strip())
    if match is None:
        raise RecordingSetError(
            _OPTION, f"found '{text}'; wanted NAME=QUANTITY[UNIT], such as pos=position[deg] or mark=ignore"
        )
    quantity, unit = match["quantity"], match["unit"]
    if quantity != IGNORE and quantity not in UNITS_OF:
        wanted = ", ".join([*UNITS_OF, IGNORE])
        raise RecordingSetError(_OPTION, f"'{quantity}' of '{text}' is no quantity; wanted one of {wanted}")
    if unit is not None and unit != STAMP:
        known = unit_named(unit)
        allowed = UNITS_OF.get(quantity, ())
        if known is None or known.si not in allowed:
            names = ", ".join(name for si in allowed for name in units_of(si))
            raise RecordingSetError(_OPTION, f"'{unit}' of '{text}' is no unit of {quantity}; wanted one of {names}")
    return Said(match["name"], quantity, unit, match["sign"])
