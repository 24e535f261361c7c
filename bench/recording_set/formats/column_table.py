"""A table in memory, of whatever format: named columns of one length."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench.recording_set.errors import RecordingSetError
from compensator.lab.recordings.recording import FloatArray

Columns = dict[str, FloatArray | list[str]]
Arrays = dict[str, NDArray[np.generic] | list[str]]
FEWEST_ROWS = 2
MOST_UNPACKED = 2 * 2**30  # bytes: a small file of these formats can hold any number of zeros
MOST_COLUMNS = 64  # of an array of two dimensions
LONGEST_NAME = 100  # characters; MATLAB's own have at most 63, and a structure's are put before them
SHOWN_OF_NAME = 20
MOST_LISTED = 20


@dataclass(frozen=True)
class ColumnTable:
    """Named columns.

    Attributes:
        place: the file as its user knows it.
        columns: name -> numbers, shape (n,), or n texts.
        rate_hz: what the file says of the sampling; None where it says nothing.
        told: what was read of the file, in words.
    """

    place: str
    columns: Columns
    rate_hz: float | None = None
    told: str = ""
    header_line: None = field(default=None, init=False)

    @property
    def header(self) -> list[str]:
        """Names of the columns."""
        return list(self.columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def error(self, message: str, line: int | None = None, column: str | None = None) -> RecordingSetError:
        """An error that names the file; these have rows, not lines."""
        return RecordingSetError(self.place, message if line is None else f"row {line}: {message}", None, column)


def check_unpacked(place: str, size_bytes: int) -> None:
    """Refuse what would not fit into memory, before it is unpacked.

    Raises:
        RecordingSetError: more than MOST_UNPACKED.
    """
    if size_bytes > MOST_UNPACKED:
        message = f"unpacks to {size_bytes} bytes; at most {MOST_UNPACKED} are read. Split the trial into several files"
        raise RecordingSetError(place, message)


def table_of(place: str, arrays: Arrays) -> ColumnTable:
    """The largest group of arrays of one length, as columns; single numbers may tell the rate.

    Args:
        place: the file as its user knows it.
        arrays: by name; of one or two dimensions, or single values.

    Raises:
        RecordingSetError: no two arrays have a length in common, or names that damaged bytes spell.
    """
    _check_names(place, arrays)
    columns: Columns = {}
    rate_hz = None
    for name, values in arrays.items():
        if isinstance(values, list):
            columns[name] = values
        elif values.size == 1:
            rate_hz = rate_hz or _rate_hz(name, values)
        elif values.size:  # MATLAB keeps every text that nobody wrote as an empty array
            columns |= _columns(name, values)
    lengths: dict[int, int] = {}
    for one in columns.values():
        lengths[len(one)] = lengths.get(len(one), 0) + 1
    length = max(lengths, key=lambda n: (lengths[n], n), default=0)
    kept = {name: one for name, one in columns.items() if len(one) == length}
    if length < FEWEST_ROWS or not kept:
        raise RecordingSetError(place, f"holds no columns of at least {FEWEST_ROWS} numbers; it has {listed(arrays)}")
    left = [name for name in columns if name not in kept]
    told = f"{len(kept)} columns of {length} rows" + (f"; of other lengths: {', '.join(left)}" if left else "")
    return ColumnTable(place, kept, rate_hz, told)


def _check_names(place: str, arrays: Arrays) -> None:
    for name in arrays:
        if len(name) > LONGEST_NAME or not name.isprintable():
            shown = "".join(sign if sign.isprintable() else "?" for sign in name[:SHOWN_OF_NAME])
            raise RecordingSetError(
                place,
                f"has a name of {len(name)} characters that begins with '{shown}'; at most {LONGEST_NAME} are read, "
                "all printable. The file may be damaged: save it again",
            )


def listed(names: Iterable[str]) -> str:
    """Names in a sentence: the first ones, and how many more there are."""
    quoted = [f"'{name}'" for name in names]
    more = f" and {len(quoted) - MOST_LISTED} more" if len(quoted) > MOST_LISTED else ""
    return (", ".join(quoted[:MOST_LISTED]) or "nothing") + more


def _columns(name: str, values: NDArray[np.generic]) -> Columns:
    """The columns of an array: of two dimensions, those along the shorter one; of records, one per field."""
    if values.dtype.names:
        found: Columns = {}
        records = np.asarray(values, dtype=values.dtype)  # of named fields
        for part in values.dtype.names:
            found |= _columns(part if name in ("", "data") else f"{name}.{part}", records[part])
        return found
    squeezed = np.squeeze(values)
    if squeezed.dtype.kind in "SU":
        return {name: [str(text) for text in np.atleast_1d(squeezed).tolist()]} if squeezed.ndim <= 1 else {}
    if squeezed.dtype.kind == "M":
        return {name: (squeezed - squeezed[0]) / np.timedelta64(1, "ns") * 1e-9} if squeezed.ndim == 1 else {}
    if squeezed.dtype.kind not in "biuf":
        return {}
    with np.errstate(invalid="ignore"):  # a NaN that signals, as damaged bytes may spell one
        numbers = squeezed.astype(float)
    numbers[np.isnan(numbers)] = np.nan  # it would go on signalling: numpy warns at the first sum
    if numbers.ndim == 1:
        return {name: numbers}
    if numbers.ndim != 2 or min(numbers.shape) > MOST_COLUMNS:
        return {}
    rows = numbers if numbers.shape[0] <= numbers.shape[1] else numbers.T
    label = name or "column"
    return {f"{label} {index + 1}": row for index, row in enumerate(rows)}


_RATES = ("fs", "rate", "rate_hz", "sample_rate", "samplerate", "sampling_rate", "sampling_frequency", "f_s")
_STEPS = ("dt", "ts", "t_s", "tsample", "sample_time", "sampling_time", "period")


def _rate_hz(name: str, values: NDArray[np.generic]) -> float | None:
    last = name.rpartition(".")[2].lower()
    if values.dtype.kind not in "iuf":
        return None
    value = float(values.ravel()[0])
    if value <= 0.0:
        return None
    return value if last in _RATES else 1.0 / value if last in _STEPS else None
