"""Parquet files, by pyarrow."""

import io

from bench.recording_set.errors import RecordingSetError, needed
from bench.recording_set.formats.column_table import Arrays, ColumnTable, check_unpacked, table_of


def read(place: str, data: bytes) -> ColumnTable:
    """The columns of a table.

    Raises:
        RecordingSetError: pyarrow is not installed, no Parquet, or no columns of numbers.
    """
    with needed(place, "pyarrow", "formats", "save as CSV"):
        import pyarrow
        from pyarrow import parquet
    try:
        opened = parquet.ParquetFile(io.BytesIO(data))
        groups = range(opened.metadata.num_row_groups)
        unpacked = sum(opened.metadata.row_group(group).total_byte_size for group in groups)
        # one value repeated packs to nothing, even before compression
        check_unpacked(place, max(unpacked, 8 * opened.metadata.num_rows * opened.metadata.num_columns))
        found = opened.read()
    except pyarrow.ArrowMemoryError:  # a MemoryError as well
        raise
    except (pyarrow.ArrowException, OSError, ValueError) as error:
        raise RecordingSetError(place, f"is no Parquet file, or a damaged one ({error}); save it again") from error
    arrays: Arrays = {}
    for name, column in zip(found.column_names, found.columns, strict=True):
        kind = column.type
        if pyarrow.types.is_string(kind) or pyarrow.types.is_large_string(kind):
            arrays[name] = [text or "" for text in column.to_pylist()]
        elif pyarrow.types.is_boolean(kind):
            arrays[name] = column.cast(pyarrow.int8()).to_numpy()
        elif pyarrow.types.is_primitive(kind):
            arrays[name] = column.to_numpy()
    return table_of(place, arrays)
