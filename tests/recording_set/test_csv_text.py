"""A recording as CSV: exact numbers, events in their rows, piece by piece."""

import csv
import io
import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bench.recording_set.stream import PIECE_ROWS, stream_of
from bench.recording_set.text.csv_text import csv_chunks, lines
from compensator.lab.recordings.recording import Event, Recording


def text_of(recording: Recording) -> str:
    return b"".join(csv_chunks(stream_of(recording))).decode()


def recording(count: int, events: list[Event]) -> Recording:
    return Recording("a", "step", {}, {"time_s": np.arange(float(count)), "duty": np.zeros(count)}, events)


@given(st.lists(st.floats(allow_nan=False), min_size=1, max_size=40))
def test_every_number_reads_back_bit_for_bit(values: list[float]) -> None:
    written = lines(np.array([values])).decode().splitlines()
    assert struct.pack(f"{len(values)}d", *map(float, written)) == struct.pack(f"{len(values)}d", *values)


def test_the_text_is_the_shortest_that_does_so() -> None:
    values = np.array([[0.1, -0.0, 1e-7, 1 / 3, np.nan, 5e-324, 1e22]])
    assert lines(values) == b"0.1\n-0.0\n1e-7\n0.3333333333333333\n\n5e-324\n1e+22\n"
    assert lines(np.array([[1.0, np.nan], [np.inf, np.nan]])) == b"1.0,inf\n,\n"
    assert lines(np.empty((3, 0))) == b""


def test_events_stand_in_their_rows_across_pieces() -> None:
    count = 2 * PIECE_ROWS + 100
    times = [-5.0, 0.5, PIECE_ROWS - 1.0, PIECE_ROWS - 0.5, float(PIECE_ROWS), count - 1.0, count + 7.0]
    events = [Event(time_s, f"e{number}") for number, time_s in enumerate(times)]
    read = list(csv.DictReader(io.StringIO(text_of(recording(count, events)))))
    assert len(read) == count
    expected = {0: ["e0"], 1: ["e1"], PIECE_ROWS - 1: ["e2"], PIECE_ROWS: ["e3", "e4"], count - 1: ["e5", "e6"]}
    found = {row: cells["event"] for row, cells in enumerate(read) if cells["event"]}
    assert list(found) == list(expected)
    assert all(name in found[row] for row, names in expected.items() for name in names)


def test_without_events_there_is_no_such_column() -> None:
    assert text_of(recording(2, [])) == "time_s,duty\n0.0,0.0\n1.0,0.0\n"
    assert text_of(recording(2, [Event(1.0, "a, b")])) == 'time_s,duty,event\n0.0,0.0,\n1.0,0.0,"a, b"\n'
