"""Tables in chunks: records stay whole, and lines are counted right."""

from pathlib import Path

import pytest

from bench.recording_set import RecordingSetError, read_recording_set
from bench.recording_set.container import Folder
from bench.recording_set.text import table
from bench.recording_set.text.table import Table
from tests.recording_set.examples import write_set

TEXT = 'a,b\n1,"two\nlines, ""quoted"""\n\n2,plain\r\n3,"x\n\ny"\n4,end'
RECORDS = [
    (3, ["1", 'two\nlines, "quoted"']),
    (5, ["2", "plain"]),
    (8, ["3", "x\n\ny"]),
    (9, ["4", "end"]),
]


def table_of(tmp_path: Path, text: str) -> Table:
    return Table(Folder(write_set(tmp_path / "set", {"t.csv": text})), "t.csv")


@pytest.mark.parametrize("characters", [1, 2, 3, 5, 8, 13, 1000])
def test_records_are_whole_however_the_file_is_cut(tmp_path: Path, characters: int) -> None:
    chunks = table_of(tmp_path, TEXT).chunks(characters)
    assert [record for chunk in chunks for record in chunk.records(2)] == RECORDS


def test_the_line_of_a_record_is_that_of_its_end(tmp_path: Path) -> None:
    (chunk,) = table_of(tmp_path, TEXT + "\n").chunks()
    assert [chunk.line_of(row) for row in range(4)] == [line for line, _ in RECORDS]


def test_a_quote_without_end_is_given_up_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table, "LONGEST_RECORD", 100)
    found = table_of(tmp_path, 'a,b\n1,2\n3,"4\n' + "5,6\n" * 100)
    with pytest.raises(RecordingSetError, match=r"t.csv, line 3: a line or a quoted cell has no end"):
        list(found.chunks(4))


@pytest.mark.parametrize("name", ["1", "nan", "0.5"])
@pytest.mark.parametrize("columns", ["time_s,duty,event", "time_s,event,duty"])
def test_an_event_that_looks_like_a_number_is_an_event(tmp_path: Path, name: str, columns: str) -> None:
    cells = [["0", "0.1", name], ["1", "0.2", ""]]
    if columns.endswith("duty"):
        cells = [[time, event, duty] for time, duty, event in cells]
    text = "\n".join([columns, *(",".join(row) for row in cells)])
    (recording,) = read_recording_set(write_set(tmp_path / "set", {"run.csv": text})).recordings
    assert [event.name for event in recording.events] == [name]
    assert recording.channels["duty"].tolist() == [0.1, 0.2]
