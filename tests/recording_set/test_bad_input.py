"""Bad input: the message names file, line and column, what was found and what is wanted."""

import io
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from bench.recording_set import Mapping, RecordingSetError, read_recording_set
from bench.recording_set.formats import column_table, matlab
from bench.recording_set.mapping import MappedTrial, Renamed
from bench.recording_set.text.toml_file import parse_toml
from tests.recording_set.examples import GOOD, write_set

# what is wrong: the CSV, and what the message must say
BAD_CSV: dict[str, tuple[str | bytes, str]] = {
    "empty file": ("", "run.csv: the file or its first line is empty; wanted a header"),
    "header only": ("time_s,duty\n", "run.csv: has 0 rows below the header; wanted at least 2"),
    "one row": ("time_s,duty\n0,1\n", "run.csv: has 1 row below the header; wanted at least 2"),
    "no time": ("position_rad,duty\n0,1\n1,1\n", "run.csv, line 1: has no column time_s"),
    "nothing but time": ("time_s\n0\n1\n", "run.csv, line 1: has no channel but time_s"),
    "text in a number": (
        "time_s,duty\n0,0.1\n1,fast\n2,0.3\n",
        "run.csv, line 3, column 'duty': found 'fast'; wanted a number in the unit of the column's name",
    ),
    "a number with groups": ("time_s,duty\n0,1\n1,1_000\n", "line 3, column 'duty': found '1_000'"),
    "time unknown": ("time_s,duty\n0,1\n,1\n", "line 3, column 'time_s': found nan; wanted a finite time"),
    "time infinite": ("time_s,duty\n0,1\ninf,1\n", "line 3, column 'time_s': found inf; wanted a finite time"),
    "number infinite": ("time_s,duty\n0,1\n1,inf\n", "line 3, column 'duty': found inf; wanted a finite number"),
    "number beyond float64": ("time_s,duty\n0,1\n1,-1e999\n", "line 3, column 'duty': found -inf; wanted a finite"),
    "time backwards": (
        "time_s,duty\n0,1\n1,1\n0.5,1\n",
        "line 4, column 'time_s': time runs backwards: found 0.5 s after 1.0 s; wanted a time that rises",
    ),
    "time stands still": (
        "time_s,duty\n0,1\n1,1\n1,1\n",
        "line 4, column 'time_s': time stands still: found 1.0 s after",
    ),
    "wrong unit": (
        "time_s,position_deg\n0,1\n1,1\n",
        "run.csv, line 1, column 'position_deg': is no known channel. position_rad is known; convert with a mapping",
    ),
    "unknown columns": (
        "time_s,humidity,wind\n0,1,1\n",
        "column 'humidity': is no known channel. Not known either: wind. Known: time_s",
    ),
    "column twice": ("time_s,duty,duty\n0,1,1\n", "line 1, column 'duty': is there twice"),
    "column without a name": ("time_s,,duty\n0,1,1\n", "line 1, column 'column 2': is no known channel"),
    "short line": ("time_s,duty\n0,1\n1\n2,1\n", "line 3: found 1 cells; wanted 2, one per column"),
    "long line": ("time_s,duty\n0,1\n1,1,1\n2,1\n", "line 3: found 3 cells; wanted 2"),
    "open quote": ('time_s,duty\n0,1\n1,"1\n2,1\n', "unexpected end of data; wanted cells between ','"),
    "stray quote": ('time_s,duty\n0,1\n1,"1"2\n2,"1"\n', "line 3: "),
    "not a table": (b"\x00\x01\x02PNG\n\x00\n", "is no text; save the table as CSV"),
}


@pytest.mark.parametrize("what", BAD_CSV)
def test_a_bad_table_is_explained(tmp_path: Path, what: str) -> None:
    content, message = BAD_CSV[what]
    folder = write_set(tmp_path / "set", {"run.csv": content})
    with pytest.raises(RecordingSetError, match=re.escape(message)) as caught:
        read_recording_set(folder)
    assert str(caught.value).startswith("set/run.csv")


def test_the_line_is_right_far_down_a_file_with_blank_and_quoted_lines(tmp_path: Path) -> None:
    rows = [f"{time},0.5,\n" for time in range(200_000)]
    rows[10] = '10,0.5,"two\nlines"\n'
    rows[20] = "\n20,0.5,\n"
    rows[150_000] = "150000,bad,\n"
    folder = write_set(tmp_path / "set", {"run.csv": "time_s,duty,event\n" + "".join(rows)})
    with pytest.raises(RecordingSetError, match="line 150004, column 'duty': found 'bad'"):
        read_recording_set(folder)


def test_time_is_watched_from_one_part_of_a_file_to_the_next(tmp_path: Path) -> None:
    times = np.arange(300_000) * 0.001
    for place in (120_000, 299_999):
        lines = [f"{time:.6f},0.5" for time in times]
        lines[place] = f"{times[place - 1]:.6f},0.5"
        folder = write_set(tmp_path / "set", {"run.csv": "time_s,duty\n" + "\n".join(lines)})
        with pytest.raises(RecordingSetError, match=f"line {place + 2}, column 'time_s': time stands still"):
            read_recording_set(folder)


# what is wrong: trials.csv, and what the message must say
BAD_TRIALS: dict[str, tuple[str, str]] = {
    "no file column": ("name,kind\nrun.csv,a\n", "trials.csv, line 1: has no column 'file'; it has name, kind"),
    "no trial": ("file,kind\n", "trials.csv: names no trial"),
    "missing file": ("file\nrun.csv\ngone.csv\n", "trials.csv, line 3, column 'file': 'gone.csv' is not in the set"),
    "file twice": ("file\nrun.csv\nrun.csv\n", "line 3, column 'file': 'run.csv' is named in line 2 already"),
    "name twice": ("file,name\nrun.csv,a\nb.csv,a\n", "line 3, column 'name': 'a' is named in line 2 already"),
    "outside": ("file\n../run.csv\n", "line 2, column 'file': the file name '../run.csv' leads out of the set"),
    "absolute": ("file\n/etc/passwd\n", "line 2, column 'file': the file name '/etc/passwd' leads out of the set"),
    "rows wrong": ("file,rows\nrun.csv,4\n", "run.csv: has 3 rows; trials.csv, line 2, says 4. Is it cut off?"),
    "rows no number": ("file,rows\nrun.csv,many\n", "line 2, column 'rows': found 'many'; wanted the number of rows"),
    "text for a load": (
        "file,load_kg\nrun.csv,heavy\n",
        "line 2, column 'load_kg': found 'heavy'; wanted a number of 0 or more [kg]",
    ),
    "load not a number": ("file,load_kg\nrun.csv,nan\n", "line 2, column 'load_kg': found 'nan'; wanted a number"),
    "negative load": ("file,load_kg\nrun.csv,-0.1\n", "line 2, column 'load_kg': found -0.1; wanted a number of 0"),
    "load in grams": (
        "file,load_g\nrun.csv,100\n",
        "column 'load_g': is not in SI; load_kg is known. Convert with a mapping: trials_columns.load_kg = {",
    ),
    "text for a flag": ("file,balanced\nrun.csv,no\n", "column 'balanced': found 'no'; wanted true or false"),
    "ragged": ("file,kind\nrun.csv\n", "trials.csv, line 2: found 1 cells; wanted 2"),
    "empty name": ("file,kind\n,a\n", "line 2, column 'file': the file name '' leads out of the set"),
}


@pytest.mark.parametrize("what", BAD_TRIALS)
def test_bad_trials_are_explained(tmp_path: Path, what: str) -> None:
    content, message = BAD_TRIALS[what]
    folder = write_set(tmp_path / "set", {"trials.csv": content, "run.csv": GOOD, "b.csv": GOOD})
    with pytest.raises(RecordingSetError, match=re.escape(message)):
        read_recording_set(folder)


# what is wrong: rig.toml, and what the message must say
BAD_RIG: dict[str, tuple[str | bytes, str]] = {
    "negative resistance": (
        'name = "x"\n\n[motor]\nresistance_ohm = -1.5\n',
        "set/rig.toml, line 4: motor.resistance_ohm: found -1.5; should be greater than 0",
    ),
    "unknown key": ('name = "x"\n[motor]\nresistance = 1\n', "rig.toml, line 3: motor.resistance: unknown key"),
    "no name": ("[motor]\n", "rig.toml, line 1: name: missing"),
    "text for a number": ('name = "x"\n[gear]\nratio = "many"\n', "rig.toml, line 3: gear.ratio: found 'many'"),
    "no TOML": ("name = \n", "rig.toml: is no TOML"),
    "no UTF-8": (b'name = "x"\n# \xb5m\n', "rig.toml, line 2: found byte 0xB5"),
}


@pytest.mark.parametrize("what", BAD_RIG)
def test_a_bad_rig_is_explained(tmp_path: Path, what: str) -> None:
    content, message = BAD_RIG[what]
    folder = write_set(tmp_path / "set", {"rig.toml": content, "run.csv": GOOD})
    with pytest.raises(RecordingSetError, match=re.escape(message)):
        read_recording_set(folder)


def test_every_problem_of_a_rig_is_named_with_its_line(tmp_path: Path) -> None:
    text = 'name = "x"\n[motor]\nresistance_ohm = 0\n[gear]\nratio = -2\n'
    folder = write_set(tmp_path / "set", {"rig.toml": text, "run.csv": GOOD})
    with pytest.raises(RecordingSetError) as caught:
        read_recording_set(folder)
    first, second = str(caught.value).splitlines()
    assert first.startswith("set/rig.toml, line 3: motor.resistance_ohm")
    assert second.startswith("set/rig.toml, line 5: gear.ratio")


def test_a_set_without_a_rig_says_how_to_write_one(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    (folder / "rig.toml").unlink()
    with pytest.raises(RecordingSetError, match=r"set/rig.toml: is not there; write one"):
        read_recording_set(folder)


def test_a_set_without_tables_is_explained(tmp_path: Path) -> None:
    with pytest.raises(RecordingSetError, match=r"set: holds no CSV; wanted trials.csv"):
        read_recording_set(write_set(tmp_path / "set", {}))
    with pytest.raises(RecordingSetError, match="there is no such folder or file"):
        read_recording_set(tmp_path / "gone")


def test_a_single_table_asks_for_a_rig(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    (folder / "rig.toml").unlink()
    with pytest.raises(RecordingSetError, match=r"run.csv: a single file has no rig; name one with --rig rig.toml"):
        read_recording_set(folder / "run.csv")


def test_a_single_table_of_a_set_is_told_where_its_rig_is(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    with pytest.raises(RecordingSetError, match=rf"import {folder}, .* or name --rig {folder}/rig.toml"):
        read_recording_set(folder / "run.csv")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("# My recordings\n\nThey are of the arm, taken in May.\n", "is the only column; wanted a table"),
        ("Notes, of today\nall was well\n", "column 'Notes': is no known channel"),
        (GOOD + "1.5,0.4\n", "line 5: found 2 cells"),
    ],
)
def test_a_single_file_that_is_no_recording_says_so_before_a_rig_is_asked_for(
    tmp_path: Path, text: str, words: str
) -> None:
    folder = write_set(tmp_path / "set", {"readme.csv": text})
    with pytest.raises(RecordingSetError, match=words):
        read_recording_set(folder / "readme.csv")


def test_a_load_of_the_mapping_is_checked_too(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    mapping = Mapping(trials=[MappedTrial(file="run.csv", conditions={"load_kg": "heavy"})])
    with pytest.raises(RecordingSetError, match=r"file 'run.csv', column 'load_kg': found 'heavy'; wanted a number"):
        read_recording_set(folder, mapping)


def test_a_load_in_grams_comes_in_through_the_mapping_that_the_message_names(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD, "trials.csv": "file,load_g\nrun.csv,100\n"})
    mapping = Mapping(trials_columns={"load_kg": Renamed(source="load_g", scale=0.001)})
    (recording,) = read_recording_set(folder, mapping).recordings
    assert recording.conditions == {"load_kg": pytest.approx(0.1)}


def test_a_structure_of_matlab_that_unpacks_to_too_much_is_refused_before(monkeypatch):
    buffer = io.BytesIO()
    savemat(buffer, {"all": {"time_s": np.zeros(300_000), "position_rad": np.zeros(300_000)}}, do_compression=True)
    for module in (matlab, column_table):
        monkeypatch.setattr(module, "MOST_UNPACKED", 2_000_000)
    with pytest.raises(RecordingSetError, match=r"unpacks to .* at most 2000000"):
        matlab.read("a.mat", buffer.getvalue())


@pytest.mark.parametrize("encoding", ["hex", "idna", "punycode", "undefined", "unicode_escape", "none-such", ""])
def test_an_encoding_that_no_file_has_is_refused(encoding):
    with pytest.raises(RecordingSetError, match="encoding of a text file"):
        parse_toml(f"encoding = '{encoding}'\n".encode(), Mapping, "mapping.toml")
