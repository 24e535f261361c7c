"""Events in the cell of a row."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench.recording_set.text.values import decode_events, encode_events
from compensator.lab.recordings.recording import Event

TEXT = st.one_of(st.text(st.characters(codec="utf-8")), st.text("ab;: [\"',\\]", max_size=6))
TIMES = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(st.builds(Event, st.one_of(st.just(1.5), TIMES), TEXT, TEXT), min_size=1, max_size=3))
def test_every_event_reads_back_as_itself(events: list[Event]) -> None:
    assert decode_events(encode_events(events, 1.5), 1.5) == events


def test_plain_events_are_plain_text() -> None:
    assert (
        encode_events([Event(2.0, "settled"), Event(2.0, "breakaway", "up, 0.31 A")], 2.0)
        == "settled; breakaway: up, 0.31 A"
    )


def test_no_event_is_an_empty_cell() -> None:
    assert encode_events([], 1.0) == ""
    assert decode_events("", 1.0) == []


@pytest.mark.parametrize("cell", ["start", "[[not json", "[[1]]", "note: a: b"])
def test_anybodys_text_is_an_event(cell: str) -> None:
    (event,) = decode_events(cell, 3.0)
    assert event.time_s == 3.0
    assert event.name == cell.partition(": ")[0]
