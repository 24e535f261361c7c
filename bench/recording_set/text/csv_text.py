"""A recording as the text of a CSV: the shortest decimals that read back as the same numbers.

The numbers are written by orjson, which was 29 times as fast as pandas when it was chosen; `make benchmark` prints
what it is now.
"""

from collections.abc import Iterator

import numpy as np
import orjson

from bench.recording_set.stream import Piece, RecordingStream
from bench.recording_set.text.table import quoted
from bench.recording_set.text.values import encode_events
from compensator.lab.recordings.recording import EVENT_COLUMN, FloatArray

NEWLINE = b"\n"


def csv_chunks(stream: RecordingStream) -> Iterator[bytes]:
    """The CSV of a recording in UTF-8, piece by piece: memory holds one piece at a time.

    The first line names the channels; nothing stands where a sample is NaN. The column `event` is there
    where the recording has events.
    """
    has_events = bool(stream.events)
    names = [*stream.channels, EVENT_COLUMN] if has_events else stream.channels
    yield ",".join(names).encode() + NEWLINE
    for piece in stream.pieces():
        yield _with_events(piece) if has_events else lines(piece.columns)


def lines(columns: FloatArray) -> bytes:
    """Lines of a CSV, each with its end; nothing stands for NaN.

    Args:
        columns: shape (columns, rows).
    """
    if not columns.shape[1]:
        return b""
    if np.isinf(columns).any():
        return _lines_one_by_one(columns)
    rows = np.ascontiguousarray(columns.T)
    text = orjson.dumps(rows, option=orjson.OPT_SERIALIZE_NUMPY)  # [[1.0,null],[2.0,0.5]]
    return text[2:-2].replace(b"],[", NEWLINE).replace(b"null", b"") + NEWLINE


def _lines_one_by_one(columns: FloatArray) -> bytes:
    """As `lines`; JSON has no word for what is infinite."""
    rows = (",".join("" if value != value else repr(value) for value in row) for row in columns.T.tolist())
    return "".join(f"{row}\n" for row in rows).encode()


def _with_events(piece: Piece) -> bytes:
    plain = lines(piece.columns)
    if not piece.events:
        return plain.replace(NEWLINE, b"," + NEWLINE)
    rows = plain.split(NEWLINE)[:-1]
    cells = {row: quoted(encode_events(found, float(piece.time_s[row]))) for row, found in piece.events.items()}
    return b"".join(row + b"," + cells.get(number, "").encode() + NEWLINE for number, row in enumerate(rows))
