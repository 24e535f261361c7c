"""MATLAB files: those up to version 7 by scipy; those of version 7.3 are HDF5."""

import io
import math
import zlib
from collections.abc import Iterator, Mapping
from typing import Any, Literal

import numpy as np

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats import hdf5
from bench.recording_set.formats.column_table import MOST_UNPACKED, ColumnTable, check_unpacked, table_of

_HDF5 = b"MATLAB 7.3"
_COMPRESSED = 15  # type of an element
_NAMES = ("Name", "name", "label")  # of a structure of a list
_PIECE = 2**20  # bytes


def read(place: str, data: bytes) -> ColumnTable:
    """The columns of a .mat: variables, and the fields of structures, of one length.

    Raises:
        RecordingSetError: no .mat, or one without columns of numbers.
    """
    if data.startswith(_HDF5) or data[:8] == hdf5.SIGNATURE:
        return hdf5.read(place, data)
    from scipy.io import loadmat, whosmat  # imported when needed: the service starts with this file

    try:
        check_unpacked(place, 8 * sum(math.prod(shape) for _, shape, _ in whosmat(io.BytesIO(data))))
        check_unpacked(place, _unpacked_bytes(data))  # of a structure whosmat tells nothing
        found = loadmat(io.BytesIO(data), squeeze_me=True, struct_as_record=False, simplify_cells=True)
    except (RecordingSetError, MemoryError):
        raise
    except Exception as error:  # damaged bytes break the library anywhere
        raise RecordingSetError(place, f"is no MATLAB file, or a damaged one ({error}); save it again") from error
    arrays = dict(_flat({name: value for name, value in found.items() if not name.startswith("__")}))
    return table_of(place, arrays)


def _unpacked_bytes(data: bytes) -> int:
    """How much the compressed elements of a file of version 5 to 7 unpack to, without keeping it; stops where enough.

    After its header of 128 bytes, a file is elements of a type, a number of bytes, and these (MAT-File Format, ch. 1).
    """
    order: Literal["little", "big"] = "little" if data[126:128] == b"IM" else "big"
    place, unpacked = 128, 0
    while place + 8 <= len(data) and unpacked <= MOST_UNPACKED:
        kind, size = (int.from_bytes(data[place + at : place + at + 4], order) for at in (0, 4))
        place += 8
        if kind == _COMPRESSED:
            unpacking, rest = zlib.decompressobj(), data[place : place + size]
            while rest and unpacked <= MOST_UNPACKED:
                unpacked += len(unpacking.decompress(rest, _PIECE))
                rest = unpacking.unconsumed_tail
        place += size
    return unpacked


def _flat(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Structures within structures as names with points; a structure that holds everything is looked through.

    Those of a list go by names of their own, where they have them, else by numbers.
    """
    for name, value in values.items():
        inner = "" if len(values) == 1 and not prefix else f"{prefix}{name}."
        if isinstance(value, dict):
            yield from _flat(value, inner)
        elif isinstance(value, list):
            yield from _flat(_named([one for one in value if isinstance(one, dict)]), inner)
        elif isinstance(value, str):
            continue
        else:
            yield f"{prefix}{name}", np.asarray(value)


def _named(structures: list[dict[str, Any]]) -> dict[str, Any]:
    """Structures of a list by their own names, or by their numbers."""
    names = [next((one[key] for key in _NAMES if isinstance(one.get(key), str)), "") for one in structures]
    told = all(names) and len(set(names)) == len(names)
    return dict(zip(names if told else map(str, range(1, len(names) + 1)), structures, strict=True))
