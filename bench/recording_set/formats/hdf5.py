"""HDF5 files, and MATLAB files of version 7.3, by h5py."""

import io
import re

import numpy as np

from bench.recording_set.errors import RecordingSetError, needed
from bench.recording_set.formats.column_table import SHOWN_OF_NAME, Arrays, ColumnTable, check_unpacked, table_of

_INSIDE = re.compile("(^|/)#[^/]*#(/|$)")  # what MATLAB keeps for itself
_OBJECT = "MATLAB_object_decode"  # attribute of what only points there
SIGNATURE = b"\x89HDF\r\n\x1a\n"


def read(place: str, data: bytes) -> ColumnTable:
    """The columns of a file: its data sets of one length, by their names.

    Raises:
        RecordingSetError: h5py is not installed, no HDF5, or no columns of numbers.
    """
    with needed(place, "h5py", "formats", "save as CSV"):
        import h5py
    arrays: Arrays = {}
    sizes: list[int] = []
    objects: list[str] = []

    def take(name: str, item: object) -> None:
        if not _INSIDE.search(name) and _OBJECT in getattr(item, "attrs", ()):
            objects.append(name)
        elif isinstance(item, h5py.Dataset) and item.dtype.kind in "biufSV" and not _INSIDE.search(name):
            if item.external or item.is_virtual:
                message = (
                    f"keeps '{name[:SHOWN_OF_NAME]}' in another file, which is not read; save it with all its data"
                )
                raise RecordingSetError(place, message)
            sizes.append(int(item.size) * int(item.dtype.itemsize))
            check_unpacked(place, sum(sizes))
            arrays[name.replace("/", ".")] = np.asarray(item)

    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            file.visititems(take)
    except (RecordingSetError, MemoryError):
        raise
    except Exception as error:  # damaged bytes break the library anywhere
        raise RecordingSetError(place, f"is no HDF5 file, or a damaged one ({error}); save it again") from error
    if objects and not arrays:
        message = (
            f"holds MATLAB objects (Simulink, timeseries), which are not read, in '{objects[0][:SHOWN_OF_NAME]}'; save "
            "plain arrays from MATLAB, such as t = x.Time; q = x.Data; save('log.mat', 't', 'q')"
        )
        raise RecordingSetError(place, message)
    return table_of(place, _without_common(arrays))


def _without_common(arrays: Arrays) -> Arrays:
    """Names without the group that all of them are in."""
    groups = {name.partition(".")[0] for name in arrays}
    if len(groups) == 1 and all("." in name for name in arrays):
        return _without_common({name.partition(".")[2]: values for name, values in arrays.items()})
    return arrays
