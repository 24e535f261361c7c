"""Conditions of a trial that a column of its file holds: by a mapping, as a user says, and by their names."""

from pathlib import Path

import numpy as np
import pytest

from bench.config.rig import Rig
from bench.recording_set import Mapping, RecordingSetError, read_mapping, read_recording_set
from bench.recording_set.guess import Known, guess_mapping, guess_of, mapping_text, read_said, read_unknown
from bench.recording_set.guess.guess import Sheet
from tests.recording_set.examples import RIG, write_set
from tests.recording_set.foreign_files import COLUMNS, POSITION_RAD, rows

LOAD = {"conditions": {"load_kg": {"from": "payload"}}}


def table(*cells: str, column: str = "payload") -> str:
    lines = [f"{0.1 * row:.1f},{row},0.5,{cell}\n" for row, cell in enumerate(cells)]
    return f"time_s,position_rad,duty,{column}\n" + "".join(lines)


def conditions_of(folder: Path, mapping: Mapping) -> list[dict]:
    return [one.conditions for one in read_recording_set(folder, mapping).recordings]


@pytest.mark.parametrize(
    ("name", "told", "cells", "wanted"),
    [
        ("load_kg", {}, ("1.6", "1.6", "1.6"), 1.6),
        ("load_kg", {"unit": "g"}, ("250", "", "250"), 0.25),
        ("load_kg", {"unit": "lb"}, ("2", "2.0"), 0.90718474),
        ("load_kg", {"scale": 0.5, "offset": 0.1}, ("2", "2"), 1.1),
        ("load_kg", {}, ("0", "0"), 0.0),
        ("arm_m", {"unit": "mm"}, ("340", "340"), 0.34),
        ("session_s", {"unit": "min"}, ("2", "2"), 120.0),
        ("repeat", {}, ("2", "2"), 2.0),
        ("balanced", {}, ("1", "1"), True),
        ("waveform", {}, ("slow sine", "slow sine"), "slow sine"),
        ("kp", {}, ("32", "32"), 32.0),
    ],
)
def test_a_column_tells_a_condition(tmp_path: Path, name: str, told: dict, cells: tuple[str, ...], wanted) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": table(*cells)})
    mapping = Mapping.model_validate({"conditions": {name: {"from": "payload", **told}}})
    assert conditions_of(folder, mapping) == [{name: pytest.approx(wanted) if isinstance(wanted, float) else wanted}]


def test_each_trial_has_its_own_and_an_empty_column_tells_none(tmp_path: Path) -> None:
    files = {"a.csv": table("0.8", "0.8"), "b.csv": table("", ""), "c.csv": "time_s,position_rad,duty\n0,0,1\n1,2,1\n"}
    folder = write_set(tmp_path / "set", files)
    assert conditions_of(folder, Mapping.model_validate(LOAD)) == [{"load_kg": 0.8}, {}, {}]


@pytest.mark.parametrize(
    ("name", "cells", "said"),
    [
        (
            "load_kg",
            ("0.8", "0.8", "1.6"),
            "run.csv, line 4, column 'payload': load_kg changes within the trial: found 0.8, 1.6; wanted one value "
            "throughout. Split the file where it changes, each part a trial; or leave the column out: no "
            "[conditions.load_kg] in the mapping, --take 'payload=ignore'",
        ),
        ("load_kg", ("1", "2", "3", "4", "5", "6"), "found 1, 2, 3, 4 and 2 more; wanted one value"),
        ("waveform", ("sine", "step"), "line 3, column 'payload': waveform changes within the trial: found 'sine'"),
        ("load_kg", ("-1", "-1"), "column 'payload': as load_kg: found -1; wanted a number of 0 or more [kg]"),
        ("load_kg", ("much", "much"), "line 2, column 'payload': found 'much'; wanted a number"),
        ("balanced", ("2", "2"), "as balanced: found '2.0'; wanted true or false"),
    ],
)
def test_a_column_that_tells_no_condition_is_refused(
    tmp_path: Path, name: str, cells: tuple[str, ...], said: str
) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": table(*cells)})
    mapping = Mapping.model_validate({"conditions": {name: {"from": "payload"}}})
    with pytest.raises(RecordingSetError) as caught:
        read_recording_set(folder, mapping)
    assert said in str(caught.value)


def test_where_the_mapping_tells_it_too_both_have_to_be_the_same(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": table("0.8", "0.8")})
    trials = [{"file": "run.csv", "conditions": {"load_kg": 0.8, "arm_m": 0.3}}]
    assert conditions_of(folder, Mapping.model_validate(LOAD | {"trials": trials})) == [{"load_kg": 0.8, "arm_m": 0.3}]
    trials[0]["conditions"]["load_kg"] = 1.6
    with pytest.raises(RecordingSetError) as caught:
        read_recording_set(folder, Mapping.model_validate(LOAD | {"trials": trials}))
    assert "run.csv, column 'payload': load_kg is 0.8 in the file, and [[trials]] of the mapping says 1.6" in str(
        caught.value
    )


def test_where_trials_csv_tells_another_value_its_line_is_named(tmp_path: Path) -> None:
    files = {"run.csv": table("0.8", "0.8"), "trials.csv": "file,load_kg\nrun.csv,1.6\n"}
    folder = write_set(tmp_path / "set", files)
    with pytest.raises(RecordingSetError, match=r"load_kg is 0\.8 in the file, and trials\.csv, line 2, says 1\.6"):
        read_recording_set(folder, Mapping.model_validate(LOAD))


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ('conditions.load_kg = { from = "payload", unit = "deg" }', "the unit is 'deg'; wanted one of kg, g, lb, oz"),
        ('conditions.repeat = { from = "n", unit = "s" }', "conditions.repeat has no unit"),
        ('conditions.load_g = { from = "payload" }', 'wanted load_kg, with unit = "g" of the column'),
        ('conditions.kind = { from = "payload" }', "a condition cannot be called so"),
        ('conditions.waveform = { from = "motion", scale = 2 }', "conditions.waveform is text"),
        ('conditions.load_kg = { form = "payload" }', "form"),
    ],
)
def test_a_mapping_that_is_wrong_is_explained(tmp_path: Path, entry: str, said: str) -> None:
    (tmp_path / "mapping.toml").write_text(entry)
    with pytest.raises(RecordingSetError) as caught:
        read_mapping(tmp_path / "mapping.toml")
    assert said in str(caught.value)


def test_a_column_that_is_in_no_file_is_named(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": table("1", "1", column="load_kg")})
    with pytest.raises(RecordingSetError, match="takes load_kg from 'payload', which is in no file; they have"):
        read_recording_set(folder, Mapping.model_validate(LOAD))
    with pytest.raises(RecordingSetError, match=r'with a mapping: conditions\.load_kg = \{ from = "load_kg" \}'):
        read_recording_set(folder, Mapping())


def test_a_load_that_no_effort_carries_is_asked_about_and_its_unit_confirms_it(tmp_path: Path) -> None:
    columns = {"time_s": COLUMNS["time_s"], "position_rad": POSITION_RAD, "torque_n_m": np.sin(POSITION_RAD)}
    columns["payload"] = np.full(len(POSITION_RAD), 250.0)
    folder = write_set(tmp_path / "set", {"run.csv": rows(columns), "rig.toml": RIG + "[arm]\nlength_m = 0.3\n"})
    with pytest.raises(RecordingSetError, match=r"Is it in g\? Say so in the mapping: conditions\.load_kg with unit"):
        read_recording_set(folder, Mapping.model_validate(LOAD))
    for unit, load_kg in (("g", 0.25), ("kg", 250.0)):
        mapping = Mapping.model_validate({"conditions": {"load_kg": {"from": "payload", "unit": unit}}})
        assert conditions_of(folder, mapping) == [{"load_kg": load_kg}]


def guess(said: tuple[str, ...] = (), **columns: float | np.ndarray):
    given = {name: np.broadcast_to(value, POSITION_RAD.shape) for name, value in columns.items()}
    sheets = [Sheet("a.csv", COLUMNS | given, None, "a.csv")]
    return guess_mapping(sheets, Known(read_said(said)))


@pytest.mark.parametrize(
    ("name", "unit"),
    [("payload_kg", None), ("load_g", "g"), ("Masse [g]", "g"), ("mass (lb)", "lb"), ("Last / kg", None)],
)
def test_a_load_is_guessed_by_its_name_where_it_is_constant(name: str, unit: str | None) -> None:
    found = guess(**{name: 2.0})
    assert found.mapping.conditions["load_kg"].source == name
    assert found.mapping.conditions["load_kg"].unit == unit
    assert not found.questions
    assert "load_kg = 0.1" not in mapping_text(found.mapping, (), ["a.csv"])  # it would say another one
    [taken] = [one for one in found.taken if one.column == name]
    assert (taken.channel, taken.unit) == ("load_kg", unit or "kg")


@pytest.mark.parametrize("name", ["arm_mass_kg", "load cell [kg]", "motor mass kg", "acc_g", "height_kg"])
def test_other_masses_are_not_taken_for_the_load(name: str) -> None:
    assert not guess(**{name: 2.0}).mapping.conditions


def test_a_column_that_changes_or_has_no_unit_says_why_it_is_not_taken() -> None:
    found = guess(payload_kg=POSITION_RAD, payload=2.0)
    assert not found.mapping.conditions
    why = {one.column: one.why for one in found.taken}
    assert why["payload_kg"] == "it changes within a trial, and load_kg has one value in each"
    assert "--take 'payload=load_kg[kg]'" in why["payload"]


def test_a_user_says_which_column_is_a_condition() -> None:
    found = guess(("payload=load_kg[g]", "payload_kg=ignore", "run=repeat"), payload=100.0, payload_kg=2.0, run=1.0)
    assert {name: (one.source, one.unit) for name, one in found.mapping.conditions.items()} == {
        "load_kg": ("payload", "g"),
        "repeat": ("run", None),
    }


@pytest.mark.parametrize(
    ("take", "said"),
    [
        ("payload=weight", "of conditions that hold for a whole trial load_kg, arm_m, session_s"),
        ("payload=load_kg[deg]", "'deg' of 'payload=load_kg[deg]' is no unit of load_kg; wanted one of kg, g, lb, oz"),
        ("payload=repeat[s]", "repeat has no unit; leave '[s]'"),
        ("payload=load_kg by duty", "load_kg has no sign; leave 'by duty'"),
    ],
)
def test_what_is_said_wrong_is_explained(take: str, said: str) -> None:
    with pytest.raises(RecordingSetError) as caught:
        read_said([take])
    assert said in str(caught.value)


def test_files_are_guessed_written_and_read_with_their_loads(tmp_path: Path) -> None:
    for name, load_g in (("a.csv", 100.0), ("b.csv", 0.0)):
        (tmp_path / name).write_text(rows(COLUMNS | {"payload_g": np.full(len(POSITION_RAD), load_g)}))
    paths = [tmp_path / "a.csv", tmp_path / "b.csv"]
    found, rig, _ = guess_of(paths, None, Known({}))
    assert not found.questions
    (tmp_path / "mapping.toml").write_text(mapping_text(found.mapping, (), found.files))
    by_file = read_recording_set(paths, read_mapping(tmp_path / "mapping.toml"), rig)
    read, _ = read_unknown(paths, None, Known({}))
    for recordings in (by_file.recordings, read.recordings):
        assert [one.conditions for one in recordings] == [{"load_kg": 0.1}, {"load_kg": 0.0}]
    said = Known(read_said(["payload_g=load_kg[kg]"]))
    assert not guess_of(paths, None, said)[0].questions
    (tmp_path / "b.csv").write_text(rows(COLUMNS | {"payload_g": POSITION_RAD}))
    (question,) = guess_of(paths, None, Known(read_said(["payload_g=load_kg[g]"])))[0].questions
    assert "load_kg changes within the trial" in question


def test_a_load_whose_place_nobody_tells_is_noted(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"a.csv": table("0.8", "0.8"), "b.csv": table("0", "0")})
    noted = read_recording_set(folder, Mapping.model_validate(LOAD)).notes
    assert [note for note in noted if "'a' is told, and not where it hangs" in note and "[arm] length_m" in note]
    rig = Rig.model_validate({"name": "mine", "arm": {"length_m": 0.3}})
    assert not [note for note in read_recording_set(folder, Mapping.model_validate(LOAD), rig).notes if "hangs" in note]
    path = tmp_path / "log.csv"
    path.write_text(rows(COLUMNS | {"payload_g": np.full(len(POSITION_RAD), 100.0)}))
    for told, wanted in ((None, 1), (rig, 0)):
        assert len([note for note in guess_of([path], told, Known({}))[0].notes if "hangs" in note]) == wanted
