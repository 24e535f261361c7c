"""Which ending is read by what."""

from collections.abc import Callable
from pathlib import PurePosixPath

from bench.recording_set.container import Container
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats import hdf5, json_lines, matlab, numpy_file, parquet_file
from bench.recording_set.formats.column_table import ColumnTable
from bench.recording_set.text.table import place

MOST_BYTES = 2 * 2**30
_READERS: dict[str, Callable[[str, bytes], ColumnTable]] = {
    ".mat": matlab.read,
    ".npz": numpy_file.read,
    ".npy": numpy_file.read,
    ".h5": hdf5.read,
    ".hdf5": hdf5.read,
    ".hdf": hdf5.read,
    ".parquet": parquet_file.read,
    ".pq": parquet_file.read,
    ".jsonl": json_lines.read,
    ".ndjson": json_lines.read,
    ".json": json_lines.read,
}
BINARY_ENDINGS = tuple(_READERS)
_REFUSED = {
    (".xlsx", ".xls", ".ods"): "is a spreadsheet; save the table as CSV from it",
    (".bag", ".mcap", ".db3"): "is a ROS bag; write the joint's topic as CSV or Parquet from it",
    (".tdms", ".mf4", ".mdf", ".dxd"): "is of a measuring program; export its channels as CSV, MAT or HDF5 from it",
}


def is_binary(file: str) -> bool:
    """Whether a file is read by a library, by its ending."""
    return _ending(file) in _READERS


def read_table(container: Container, file: str) -> ColumnTable:
    """A file of one of these formats.

    Raises:
        RecordingSetError: too large, damaged, or without columns of numbers.
    """
    where = place(container, file)
    with container.open(file) as opened:
        data = opened.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise RecordingSetError(where, f"is larger than {MOST_BYTES} bytes; split the trial into several files")
    try:
        return _READERS[_ending(file)](where, data)
    except MemoryError as error:
        message = "needs more memory than there is to be read; split the trial into several files, or save it as CSV"
        raise RecordingSetError(where, message) from error


def check_readable(container: Container, file: str) -> None:
    """Refuse endings that are known and not read, with what helps."""
    for endings, message in _REFUSED.items():
        if _ending(file) in endings:
            raise RecordingSetError(place(container, file), message)


def _ending(file: str) -> str:
    return PurePosixPath(file).suffix.lower()
