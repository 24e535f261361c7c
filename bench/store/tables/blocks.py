"""Sample blocks: rows of a trial as bytes, and back.

A block is the columns one after the other, each as little-endian float64: one channel can be taken
out without touching the others. Not compressed: zlib saves 4 % of a noisy simulated trial and would
bound the store to some 30 MB/s.
"""

import numpy as np
from numpy.typing import NDArray

from compensator.lab.recordings.recording import FloatArray

STORED = np.dtype("<f8")
SAMPLE_BYTES = STORED.itemsize


def columns_of(rows: FloatArray) -> FloatArray:
    """Rows, shape (rows, channels), as columns in memory, shape (channels, rows)."""
    return np.ascontiguousarray(np.asarray(rows, dtype=STORED).T)


def encode(columns: FloatArray) -> bytes:
    """Bytes of a block.

    Args:
        columns: shape (channels, rows).
    """
    return np.asarray(columns, dtype=STORED).tobytes(order="C")


def decode(data: bytes, channels: int) -> NDArray[np.float64]:
    """Columns of a block, shape (channels, rows), read-only."""
    return np.frombuffer(data, dtype=STORED).reshape(channels, -1)
