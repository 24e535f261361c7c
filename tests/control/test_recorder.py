"""Rows reach their sink in order, soon, and a sink that is gone is noticed."""

import threading
import time
from contextlib import suppress

import numpy as np
import pytest

from bench.control.recorder import Recorder
from bench.errors import RecordingError
from tests.control.fake_drive import ListSink


def test_rows_and_events_arrive_together_and_in_order():
    arrived = []

    class Sink:
        def append(self, rows, events):
            arrived.append((rows[:, 0].tolist(), events))

    recorder = Recorder(Sink(), 2)
    recorder.row((1.0, 2.0))
    recorder.event(1.0, "a", "")
    recorder.row((3.0, 4.0))
    recorder.event(3.0, "b", "up")
    recorder.close()
    assert arrived == [([1.0, 3.0], [(1.0, "a", ""), (3.0, "b", "up")])]


def test_an_event_without_rows_arrives_too():
    sink = ListSink()
    recorder = Recorder(sink, 2)
    recorder.event(0.0, "end", "refused")
    recorder.close()
    assert sink.events == [(0.0, "end", "refused")]


def test_rows_are_handed_over_while_the_trial_runs():
    sink = ListSink()
    recorder = Recorder(sink, 1)
    deadline_s = time.monotonic() + 10.0
    while len(sink.blocks) < 2 and time.monotonic() < deadline_s:
        recorder.row((time.monotonic(),))
        time.sleep(0.01)
    assert len(sink.blocks) >= 2
    # no block spans much more than what may be lost
    assert np.ptp(sink.blocks[1]) < 3 * Recorder.BLOCK_S
    recorder.close()


def test_many_rows_do_not_wait_for_the_clock():
    sink = ListSink()
    recorder = Recorder(sink, 1)
    for row in range(Recorder.BLOCK_ROWS * 2):
        recorder.row((float(row),))
    recorder.close()
    assert max(len(block) for block in sink.blocks) <= Recorder.BLOCK_ROWS
    np.testing.assert_array_equal(np.vstack(sink.blocks)[:, 0], np.arange(Recorder.BLOCK_ROWS * 2))


def test_a_failure_is_raised_and_the_thread_ends():
    threads = threading.active_count()
    recorder = Recorder(ListSink(fail_on_block=0), 1)
    recorder.row((1.0,))
    with pytest.raises(RecordingError, match="No space left on device"):
        recorder.close()
    assert threading.active_count() == threads


@pytest.mark.parametrize("patience_s", [0.0, 0.05])
def test_a_sink_that_hangs_does_not_hang_the_loop_for_good(monkeypatch, patience_s):
    monkeypatch.setattr(Recorder, "BACKLOG", 2)
    monkeypatch.setattr(Recorder, "BLOCK_ROWS", 1)
    release = threading.Event()

    class Hanging(ListSink):
        def append(self, rows, events=()):
            release.wait(30.0)

    recorder = Recorder(Hanging(), 1, patience_s)
    began_s = time.monotonic()
    with pytest.raises(RecordingError, match="2 blocks are waiting"):
        fill(recorder)
    assert patience_s <= time.monotonic() - began_s < 1.0
    monkeypatch.setattr(Recorder, "LAST_PATIENCE_S", 0.05)
    with pytest.raises(RecordingError, match="has not taken"):
        recorder.close()
    release.set()


def test_a_real_joint_does_not_move_on_while_one_block_takes_too_long(monkeypatch):
    monkeypatch.setattr(Recorder, "STALL_S", 0.05)
    monkeypatch.setattr(Recorder, "BLOCK_ROWS", 1)
    held = threading.Event()

    class Locked(ListSink):
        def append(self, rows, events=()):
            held.wait(30.0)
            super().append(rows, events)

    sink = Locked()
    recorder, began_s = Recorder(sink, 1), time.monotonic()
    with pytest.raises(RecordingError, match=r"at one block for more than 0\.05 s"):
        _fill_slowly(recorder)
    assert 0.05 <= time.monotonic() - began_s < 1.0
    held.set()
    with suppress(RecordingError):
        recorder.close()
    assert sink.blocks  # what it was at is kept


def _fill_slowly(recorder):
    until_s = time.monotonic() + 5.0
    while time.monotonic() < until_s:
        recorder.row((1.0,))
        time.sleep(0.001)


def fill(recorder, rows=range(100)):
    for row in rows:
        recorder.row((float(row),))


def test_a_full_backlog_is_worked_through_at_the_end(monkeypatch):
    monkeypatch.setattr(Recorder, "BACKLOG", 3)
    monkeypatch.setattr(Recorder, "BLOCK_ROWS", 1)

    class Slow(ListSink):
        def append(self, rows, events=()):
            time.sleep(0.01)
            super().append(rows, events)

    sink = Slow()
    recorder = Recorder(sink, 1, patience_s=10.0)
    fill(recorder)
    recorder.close()
    assert len(sink.blocks) == 100


def test_a_block_that_the_backlog_has_no_room_for_waits_and_loses_nothing(monkeypatch):
    monkeypatch.setattr(Recorder, "BACKLOG", 1)
    monkeypatch.setattr(Recorder, "BLOCK_ROWS", 4)
    monkeypatch.setattr(Recorder, "BLOCK_S", 1e6)
    in_hand, release = threading.Event(), threading.Event()

    class Slow(ListSink):
        def append(self, rows, events=()):
            in_hand.set()
            assert release.wait(30.0)
            super().append(rows, events)

    sink = Slow()
    recorder = Recorder(sink, 1)
    fill(recorder, range(4))
    assert in_hand.wait(30.0)
    fill(recorder, range(4, 11))
    for late in range(11, 30):
        with pytest.raises(RecordingError, match="does not keep up"):
            fill(recorder, [late])
    release.set()
    deadline_s = time.monotonic() + 10.0
    while len(sink.blocks) < 2 and time.monotonic() < deadline_s:  # then there is room again
        time.sleep(0.001)
    recorder.close()
    np.testing.assert_array_equal(np.vstack(sink.blocks)[:, 0], np.arange(30.0))
