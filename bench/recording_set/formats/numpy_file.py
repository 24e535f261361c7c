"""Files of numpy: .npz, .npy."""

import io
import zipfile

import numpy as np

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import ColumnTable, check_unpacked, table_of


def read(place: str, data: bytes) -> ColumnTable:
    """The columns of a .npz or .npy; nothing is unpickled.

    Raises:
        RecordingSetError: none of them, one that holds Python objects, or none with columns of numbers.
    """
    try:
        if zipfile.is_zipfile(io.BytesIO(data)):
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                check_unpacked(place, sum(info.file_size for info in archive.infolist()))
        found = np.load(io.BytesIO(data), allow_pickle=False)
        arrays = {"": found} if isinstance(found, np.ndarray) else {name: found[name] for name in found.files}
    except (RecordingSetError, MemoryError):
        raise
    except ValueError as error:
        message = f"cannot be read ({error}); save plain arrays: numpy.savez(file, time_s=..., position_rad=...)"
        raise RecordingSetError(place, message) from error
    except Exception as error:  # damaged bytes break the library anywhere
        raise RecordingSetError(place, f"is no numpy file, or a damaged one ({error}); save it again") from error
    return table_of(place, arrays)
