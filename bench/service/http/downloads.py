"""The samples of a trial as JSON, piece by piece.

Whoever writes JSON keeps the interpreter until it is written. Two million numbers in one go would keep it for a second
or two, from STOP, too; between pieces others have their turn.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json


def attachment(name: str) -> dict[str, Any]:
    """As the description of an answer has it, with a name for example."""
    said = {
        "schema": {"type": "string"},
        "description": "name of the file",
        "example": f'attachment; filename="{name}"',
    }
    return {"Content-Disposition": said}


PARQUET = "application/vnd.apache.parquet"
PARQUET_ANSWER = {
    "description": "SI, the unit in the column's name; numbers are exact.",
    "content": {PARQUET: {"schema": {"type": "string", "format": "binary"}}},
    "headers": attachment("trial-1.parquet"),
}
AT_ONCE = 10_000  # numbers


def samples_json(
    trial_id: int,
    rows_recorded: int,
    channels: Mapping[str, NDArray[np.float64]],
    gaps: Sequence[tuple[float, float]] = (),
) -> bytes:
    """The same text as that of `Samples`.

    Args:
        trial_id: the trial.
        rows_recorded: of all of it.
        channels: what is answered of it, arrays of one length, `time_s` among them.
        gaps: from, to [s].
    """
    rows = len(channels["time_s"])
    told = [{"from_s": from_s, "to_s": to_s} for from_s, to_s in gaps]
    facts = {"trial_id": trial_id, "rows_recorded": rows_recorded, "rows_returned": rows, "gaps": told}
    listed = b",".join(b"%b:[%b]" % (to_json(name), b",".join(_pieces(values))) for name, values in channels.items())
    return b'%b,"channels":{%b}}' % (to_json(facts).removesuffix(b"}"), listed)


def _pieces(values: NDArray[np.float64]) -> Iterator[bytes]:
    for start in range(0, len(values), AT_ONCE):
        yield to_json(column(values[start : start + AT_ONCE]))[1:-1]


def column(values: NDArray[np.float64]) -> list[float | None]:
    """A column as JSON numbers; NaN and infinities become None."""
    listed: list[float | None] = values.tolist()
    for index in np.flatnonzero(~np.isfinite(values)).tolist():
        listed[index] = None
    return listed
