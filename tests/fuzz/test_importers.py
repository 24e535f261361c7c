"""Files of other labs and sets of our own, spoilt at random: read, or refused with a sentence that names them."""

import io
import zipfile
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from bench.config.rig import Rig
from bench.errors import BenchError
from bench.recording_set import read_recording_set
from bench.recording_set.guess import Known, read_unknown
from bench.recording_set.recording_set import RecordingSet
from tests.fuzz.edits import EDITS, Edit, spoilt
from tests.fuzz.effort import effort
from tests.recording_set.examples import GOOD, RIG
from tests.recording_set.foreign_files import FILES

EXAMPLES = 120
LONGEST_MESSAGE = 3000  # it may list columns; what a file holds is cut
SPOILT = st.lists(EDITS, min_size=1, max_size=4)
MEMBERS = {
    "rig.toml": RIG,
    "mapping.toml": """[columns]
i = {channel = "current_a", scale = 0.001}
[trials_columns]
last = {name = "load_kg"}
""",
    "trials.csv": "file,kind,last,note\na.csv,step,0.05,x\nb.csv,step,0.1,\n",
    "a.csv": "time_s,position_rad,i\n0.0,0.1,500\n0.5,0.2,250\n1.0,0.3,-1\n",
    "b.csv": GOOD,
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("spoilt")


def check_read(found: RecordingSet) -> None:
    """What was taken in is whole: every channel as long as its time, and every time finite and rising."""
    assert found.recordings
    for recording in found.recordings:
        time_s = recording.channels["time_s"]
        assert (time_s[1:] > time_s[:-1]).all()
        assert {len(values) for values in recording.channels.values()} == {len(time_s)}


def check_refused(error: BenchError, name: str) -> None:
    """A refusal says which file it is about, and does not repeat what is in it."""
    message = str(error)
    assert name in message
    assert len(message) < LONGEST_MESSAGE


@given(what=st.sampled_from(sorted(FILES)), edits=SPOILT)
@effort(EXAMPLES)
def test_a_foreign_file_is_read_or_refused(folder: Path, what: str, edits: list[Edit]) -> None:
    foreign = FILES[what]
    path = folder / foreign.name
    path.write_bytes(spoilt(foreign.data, edits))
    try:
        found, _ = read_unknown([path], Rig(name="spoilt"), foreign.known)
    except BenchError as error:
        check_refused(error, path.stem)
    else:
        check_read(found)


@given(member=st.sampled_from(sorted(MEMBERS)), edits=SPOILT)
@effort(EXAMPLES)
def test_a_set_of_our_own_is_read_or_refused(folder: Path, member: str, edits: list[Edit]) -> None:
    path = folder / "own.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in MEMBERS.items():
            archive.writestr(name, spoilt(text.encode(), edits if name == member else []))
    try:
        check_read(read_recording_set(path))
    except BenchError as error:
        check_refused(error, "own")


def whole_zip() -> bytes:
    """The set as a zip."""
    with io.BytesIO() as written:
        with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, text in MEMBERS.items():
                archive.writestr(name, text)
        return written.getvalue()


@given(edits=SPOILT)
@example(edits=[])
@effort(EXAMPLES)
def test_a_spoilt_archive_is_read_or_refused(folder: Path, edits: list[Edit]) -> None:
    path = folder / "archive.zip"
    path.write_bytes(spoilt(whole_zip(), edits))
    try:
        check_read(read_unknown([path], None, Known({}))[0])
    except BenchError as error:
        check_refused(error, "archive")


CELLS = st.one_of(
    st.floats(allow_nan=True).map(str),
    st.integers().map(str),
    st.text(max_size=12),
    st.sampled_from(
        ["", " ", "1,5", "1.000,5", "1e-400", "0x1F", "12:30:01,5", "2026-05-04T23:59:58Z", "°", "-", "+", "NaN"]
    ),
)
HEADS = st.one_of(
    st.sampled_from(["time_s", "t", "Zeit [ms]", "position_rad", "theta (deg)", "i", "Strom [mA]", "event", "rpm", ""]),
    st.text(max_size=12),
)


@given(
    head=st.lists(HEADS, min_size=1, max_size=6),
    rows=st.lists(st.lists(CELLS, max_size=7), max_size=12),
    delimiter=st.sampled_from([",", ";", "\t", "|", "  "]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "cp1252", "utf-16-be"]),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
)
@effort(EXAMPLES)
def test_a_table_of_anything_is_read_or_refused(
    folder: Path, head: list[str], rows: list[list[str]], delimiter: str, encoding: str, end: str
) -> None:
    path = folder / "table.csv"
    text = end.join(delimiter.join(row) for row in [head, *rows])
    path.write_bytes(text.encode(encoding, errors="replace"))
    try:
        check_read(read_unknown([path], None, Known({}))[0])
    except BenchError as error:
        check_refused(error, path.stem)
