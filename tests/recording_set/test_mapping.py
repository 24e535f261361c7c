"""The mapping file: columns of another shape become channels and conditions."""

import re
from pathlib import Path

import pytest

from bench.recording_set import Mapping, RecordingSetError, read_mapping, read_recording_set
from tests.recording_set.examples import GOOD, write_set


def mapping_of(tmp_path: Path, text: str) -> Mapping:
    (tmp_path / "mapping.toml").write_text(text)
    return read_mapping(tmp_path / "mapping.toml")


def test_columns_are_scaled_renamed_and_ignored(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": "t_ms,drive_v,mark,target_m\n0,2,x,1\n500,-4,y,2\n"})
    mapping = mapping_of(
        tmp_path,
        """
        ignore = ["mark"]
        [columns.time_s]
        from = "t_ms"
        scale = 0.001
        [columns.force_n]
        from = "drive_v"
        scale = 35.0
        offset = 1.0
        [columns.voltage_v]
        from = "drive_v"
        """,
    )
    (recording,) = read_recording_set(folder, mapping).recordings
    assert {name: values.tolist() for name, values in recording.channels.items()} == {
        "target_m": [1.0, 2.0],
        "time_s": [0.0, 0.5],
        "force_n": [71.0, -139.0],
        "voltage_v": [2.0, -4.0],
    }


def test_a_channel_may_be_converted_in_place(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    mapping = mapping_of(tmp_path, '[columns.duty]\nfrom = "duty"\nscale = -1\n')
    (recording,) = read_recording_set(folder, mapping).recordings
    assert recording.channels["duty"].tolist() == [-0.5, -0.25, 1.0]


def test_a_known_column_may_be_ignored(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    (recording,) = read_recording_set(folder, Mapping(ignore=["duty"])).recordings
    assert list(recording.channels) == ["time_s", "position_rad"]


def test_trials_columns_are_renamed_and_the_kind_stays_a_tag(tmp_path: Path) -> None:
    trials = "path,trajectory,load_g,secret,empty\nrun.csv,sin_sin,100,x,\n"
    folder = write_set(tmp_path / "set", {"run.csv": GOOD, "trials.csv": trials})
    mapping = mapping_of(
        tmp_path,
        """
        ignore = ["secret"]
        [trials_columns]
        file = "path"
        kind = "trajectory"
        load_kg = { from = "load_g", scale = 0.001 }
        """,
    )
    (recording,) = read_recording_set(folder, mapping).recordings
    assert recording.kind == "sin_sin"
    assert recording.conditions == {"trajectory": "sin_sin", "load_kg": 0.1}


def test_trials_may_be_listed_where_there_is_no_trials_csv(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"b.csv": GOOD, "a.csv": GOOD, "notes.csv": "not,for\nus,!\n"})
    mapping = mapping_of(
        tmp_path,
        """
        [[trials]]
        file = "b.csv"
        kind = "reference"
        conditions = { load_kg = 0.1, balanced = true, grease = "NLGI 2", repeat = 1 }
        [[trials]]
        file = "a.csv"
        """,
    )
    b, a = read_recording_set(folder, mapping).recordings
    assert (b.name, b.kind) == ("b", "reference")
    assert b.conditions == {"load_kg": 0.1, "balanced": True, "grease": "NLGI 2", "repeat": 1.0}
    assert type(b.conditions["balanced"]) is bool
    assert (a.name, a.kind, a.conditions) == ("a", "recording", {})


def test_without_lists_every_table_is_a_trial(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"b.csv": GOOD, "a.csv": GOOD})
    found = read_recording_set(folder)
    assert [(recording.name, recording.kind) for recording in found.recordings] == [
        ("a", "recording"),
        ("b", "recording"),
    ]


def test_a_continental_spreadsheet_is_read(tmp_path: Path) -> None:
    files = {
        "run.csv": b'\xef\xbb\xbftime_s;duty;event\r\n0,0;0,5;\r\n0,5;-0,25;"halt; hier"\r\n\r\n',
        "trials.csv": b"\xef\xbb\xbffile;load_kg;balanced\r\nrun.csv;0,05;TRUE\r\n",
    }
    folder = write_set(tmp_path / "set", files)
    (recording,) = read_recording_set(folder, Mapping(delimiter=";", decimal=",")).recordings
    assert recording.channels["time_s"].tolist() == [0.0, 0.5]
    assert recording.channels["duty"].tolist() == [0.5, -0.25]
    assert recording.conditions == {"load_kg": 0.05, "balanced": True}
    assert [event.name for event in recording.events] == ["halt", "hier"]


# what is wrong: the mapping, and what the message must say
BAD: dict[str, tuple[str, str]] = {
    "unknown channel": ('[columns.position_deg]\nfrom = "x"\n', "mapping.toml, line 1: columns.position_deg"),
    "scale of zero": ('[columns.duty]\nfrom = "x"\nscale = 0\n', "mapping.toml, line 3: columns.duty.scale: found 0"),
    "no source": ("[columns.duty]\nscale = 1.0\n", "mapping.toml, line 1: columns.duty.from: missing"),
    "unknown key": ('colums = "x"\n', "mapping.toml, line 1: colums: unknown key"),
    "unknown key of a column": (
        '[columns.position_rad]\nfrom = "x"\nunits = "deg"\n',
        "mapping.toml, line 3: columns.position_rad.units: unknown key; did you mean 'unit'? "
        "(allowed: from, scale, offset, unit, period, sign_from)",
    ),
    "signs the same": ('delimiter = ","\ndecimal = ","\n', "delimiter and decimal are both ','"),
    "condition without value": (
        '[[trials]]\nfile = "a.csv"\nconditions = { load_kg = nan }\n',
        "mapping.toml, line 3: trials.0.conditions.load_kg: found nan; wanted a finite",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_mapping_is_explained(tmp_path: Path, what: str) -> None:
    text, message = BAD[what]
    with pytest.raises(RecordingSetError, match=re.escape(message)):
        mapping_of(tmp_path, text)


# what does not fit the set: the mapping, and what the message must say
UNFIT: dict[str, tuple[str, str]] = {
    "source nowhere": (
        '[columns.force_n]\nfrom = "drive_v"\n',
        "the mapping takes force_n from 'drive_v', which is in no file; they have duty, position_rad, time_s",
    ),
    "channel there already": ('[columns.duty]\nfrom = "position_rad"\n', "is mapped from 'position_rad' too"),
    "trial missing": (
        '[[trials]]\nfile = "gone.csv"\n',
        "the mapping's [[trials]], column 'file': 'gone.csv' is not in",
    ),
    "trial twice": ('[[trials]]\nfile = "run.csv"\n[[trials]]\nfile = "run.csv"\n', "'run.csv' is listed twice"),
    "trial outside": ('[[trials]]\nfile = "../run.csv"\n', "leads out of the set"),
}


@pytest.mark.parametrize("what", UNFIT)
def test_a_mapping_that_does_not_fit_is_explained(tmp_path: Path, what: str) -> None:
    text, message = UNFIT[what]
    folder = write_set(tmp_path / "set", {"run.csv": GOOD})
    with pytest.raises(RecordingSetError, match=re.escape(message)):
        read_recording_set(folder, mapping_of(tmp_path, text))


# what does not fit trials.csv (file,load_g,tag / run.csv,100,x): the mapping, and what the message must say
UNFIT_TRIALS: dict[str, tuple[str, str]] = {
    "source missing": (
        '[trials_columns]\nkind = "trajectory"\n',
        "takes 'kind' from a column 'trajectory', which is not",
    ),
    "name taken": ('[trials_columns]\ntag = "load_g"\n', "column 'tag': is a column, and is mapped from 'load_g' too"),
    "text scaled": (
        '[trials_columns]\nload_kg = { from = "load_g", scale = 0.001 }\nx = { from = "tag", scale = 2 }\n',
        "line 2, column 'tag': found 'x'; wanted a number",
    ),
    "listed twice over": ('[[trials]]\nfile = "run.csv"\n', "is there, and the mapping lists trials too"),
}


@pytest.mark.parametrize("what", UNFIT_TRIALS)
def test_a_mapping_that_does_not_fit_trials_csv_is_explained(tmp_path: Path, what: str) -> None:
    text, message = UNFIT_TRIALS[what]
    folder = write_set(tmp_path / "set", {"run.csv": GOOD, "trials.csv": "file,load_g,tag\nrun.csv,100,x\n"})
    with pytest.raises(RecordingSetError, match=re.escape(message)):
        read_recording_set(folder, mapping_of(tmp_path, text))


def test_a_mapping_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingSetError, match=r"gone.toml: cannot be read: No such file"):
        read_mapping(tmp_path / "gone.toml")
