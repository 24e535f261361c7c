"""An effort without its sign: asked about where another column shows that there is one."""

import numpy as np

from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.assign import Assigned
from bench.recording_set.guess.names import UNITS_OF
from compensator.lab.recordings.recording import FloatArray

SIGNED = ("duty", "voltage", "current_command", "torque", "force", "current")  # of the drive, the nearest first
EITHER_WAY = 0.1  # share of the samples on the rarer side of 0, from which a column is of both signs
BELOW = 0.02  # of the largest value: an offset of a sensor, and no sign


def magnitude_questions(files: list[Columns], assigned: Assigned) -> list[str]:
    """Efforts that are never below 0, while the drive pushes both ways; each question names its option."""
    found = []
    for quantity in ("current", "torque", "force"):
        name = assigned.columns.get(quantity, ("",))[0]
        if name in assigned.said or not _never_below(_values(files, name)):
            continue
        other = next((one for one in _others(assigned, name) if _both_ways(_values(files, one))), None)
        if other is not None:
            plain = f"{name}={quantity}[{UNITS_OF[quantity][0]}]"
            found.append(
                f"'{name}' is never below 0, while '{other}' is of both signs: say --take '{plain} by {other}' where "
                f"it is a magnitude, else --take '{plain}'"
            )
    return found


def _others(assigned: Assigned, name: str) -> list[str]:
    return [names[0] for one in SIGNED if (names := assigned.columns.get(one)) and names[0] != name]


def _values(files: list[Columns], name: str) -> FloatArray:
    arrays = [columns[name] for columns in files if name in columns]
    numbers = [np.asarray(one) for one in arrays if not isinstance(one, list)]
    values: FloatArray = np.concatenate(numbers) if numbers else np.array([])
    return values[np.isfinite(values)]


def _never_below(values: FloatArray) -> bool:
    return len(values) > 0 and float(values.max()) > 0.0 and float(values.min()) >= -BELOW * float(values.max())


def _both_ways(values: FloatArray) -> bool:
    return len(values) > 0 and min(float(np.mean(values > 0.0)), float(np.mean(values < 0.0))) >= EITHER_WAY
