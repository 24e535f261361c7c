"""Recordings as Parquet, for pandas, DuckDB, Polars, MATLAB: all trials in one table, written piece by piece.

The columns: `trial_id`, `trial` (its name), one per channel (SI, the unit in the name; null where not
measured), `event`, and one per condition, `condition_load_kg`. Conditions are stored once per piece.
"""

import io
from collections.abc import Iterator, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.recording_set.errors import needed
from bench.recording_set.stream import Piece, RecordingStream
from bench.recording_set.text.values import encode_events
from compensator.lab.recordings.recording import EVENT_COLUMN, Condition

if TYPE_CHECKING:
    import pyarrow

CONDITION_PREFIX = "condition_"


def parquet_chunks(streams: Sequence[RecordingStream]) -> Iterator[bytes]:
    """The bytes of a Parquet file, one row group after the other.

    Args:
        streams: at least one; of the same rig.

    Raises:
        RecordingSetError: pyarrow is not installed. Raised here, not when the first chunk is asked for.
    """
    with needed("Parquet", "pyarrow", "parquet", "export CSV"):
        import pyarrow
    return _chunks(pyarrow, streams)


def _chunks(pa: ModuleType, streams: Sequence[RecordingStream]) -> Iterator[bytes]:
    from pyarrow import parquet

    layout = _Layout(pa, streams)
    written = _Written()
    with parquet.ParquetWriter(pa.PythonFile(written, mode="w"), layout.schema) as writer:
        for stream in streams:
            for piece in stream.pieces():
                writer.write_table(layout.table(stream, piece))
                yield written.take()
    yield written.take()


class _Layout:
    """Which columns there are, and a piece as a table of them."""

    def __init__(self, pa: ModuleType, streams: Sequence[RecordingStream]) -> None:
        self._pa = pa
        self.channels = tuple(dict.fromkeys(name for stream in streams for name in stream.channels))
        kinds: dict[str, set[type]] = {}
        for stream in streams:
            for key, value in stream.conditions.items():
                kinds.setdefault(key, set()).add(type(value))
        self.conditions = {key: self._kind(found) for key, found in kinds.items()}
        fields = [("trial_id", pa.int64()), ("trial", self._repeated(pa.string()))]
        fields += [(name, pa.float64()) for name in self.channels] + [(EVENT_COLUMN, pa.string())]
        fields += [(CONDITION_PREFIX + key, self._repeated(kind)) for key, kind in self.conditions.items()]
        self.schema = pa.schema(fields)

    def table(self, stream: RecordingStream, piece: Piece) -> "pyarrow.Table":
        """The rows of a piece."""
        count = piece.columns.shape[1]
        columns = [self._constant(self._pa.int64(), stream.trial_id, count).dictionary_decode()]
        columns.append(self._constant(self._pa.string(), stream.name, count))
        columns += [self._channel(stream, piece, name) for name in self.channels]
        columns.append(self._events(piece))
        for key, kind in self.conditions.items():
            columns.append(self._constant(kind, self._value(kind, stream.conditions.get(key)), count))
        return self._pa.table(columns, schema=self.schema)

    def _channel(self, stream: RecordingStream, piece: Piece, name: str) -> Any:
        if name not in stream.channels:
            return self._pa.nulls(piece.columns.shape[1], self._pa.float64())
        values = piece.columns[stream.channels.index(name)]
        return self._pa.array(values, mask=np.isnan(values))

    def _events(self, piece: Piece) -> Any:
        cells: list[str | None] = [None] * piece.columns.shape[1]
        for row, found in piece.events.items():
            cells[row] = encode_events(found, float(piece.time_s[row]))
        return self._pa.array(cells, self._pa.string())

    def _constant(self, kind: Any, value: object, count: int) -> Any:
        codes = self._pa.array(np.zeros(count, np.int32), mask=np.full(count, value is None))
        return self._pa.DictionaryArray.from_arrays(codes, self._pa.array([] if value is None else [value], kind))

    def _kind(self, found: set[type]) -> Any:
        if found == {bool}:
            return self._pa.bool_()
        return self._pa.float64() if found <= {int, float} else self._pa.string()

    def _value(self, kind: Any, value: Condition | None) -> Condition | None:
        return str(value) if value is not None and kind == self._pa.string() else value

    def _repeated(self, kind: Any) -> Any:
        return self._pa.dictionary(self._pa.int32(), kind)


class _Written(io.RawIOBase):
    """What the writer has written since it was last taken away."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._position = 0

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        part = bytes(data)
        self._parts.append(part)
        self._position += len(part)
        return len(part)

    def tell(self) -> int:
        return self._position

    def take(self) -> bytes:
        parts, self._parts = self._parts, []
        return b"".join(parts)
