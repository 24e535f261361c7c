"""Files as other labs write them: read right, or one sentence that names the mend; nothing half-imported."""

import random
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from bench.config.rig import Arm, Rig
from bench.recording_set import (
    RecordingSet,
    RecordingSetError,
    read_mapping,
    read_recording_set,
    write_recording_set,
)
from bench.recording_set.formats import column_table
from bench.recording_set.guess import Known, guess_of, mapping_text, read_unknown
from compensator.lab.recordings.recording import Event, Recording
from tests.recording_set.foreign_files import FILES


def test_there_are_sixty_of_them() -> None:
    assert len(FILES) >= 60


@pytest.mark.parametrize("what", FILES)
def test_a_foreign_file_is_read_right_or_refused_with_the_mend(tmp_path: Path, what: str) -> None:
    foreign = FILES[what]
    path = tmp_path / foreign.name
    path.write_bytes(foreign.data)
    if foreign.asks:
        with pytest.raises(RecordingSetError) as caught:
            read_unknown([path], None, foreign.known)
        assert re.search(foreign.asks, str(caught.value)), caught.value
        return
    found, _ = read_unknown([path], None, foreign.known)
    (recording,) = found.recordings
    for channel, values in foreign.truth.items():
        assert channel in recording.channels, sorted(recording.channels)
        np.testing.assert_allclose(recording.channels[channel], values, atol=10.0**-foreign.digits, err_msg=channel)


@pytest.mark.parametrize("what", [name for name, foreign in FILES.items() if not foreign.asks])
def test_the_mapping_that_is_written_reads_the_same(tmp_path: Path, what: str) -> None:
    foreign = FILES[what]
    path = tmp_path / foreign.name
    path.write_bytes(foreign.data)
    guess, rig, _ = guess_of([path], None, foreign.known)
    (tmp_path / "mapping.toml").write_text(mapping_text(guess.mapping, ("a remark",)), encoding="utf-8")
    (again,) = read_recording_set(path, read_mapping(tmp_path / "mapping.toml"), rig).recordings
    (first,) = read_unknown([path], None, foreign.known)[0].recordings
    assert again.channels.keys() == first.channels.keys()
    for channel, values in first.channels.items():
        np.testing.assert_array_equal(again.channels[channel], values)


@pytest.mark.parametrize("ending", [".npz", ".mat", ".h5", ".parquet"])
def test_what_would_fill_the_memory_is_refused_before_it_is_unpacked(
    tmp_path: Path, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(column_table, "MOST_UNPACKED", 1000)
    foreign = next(one for one in FILES.values() if one.name.endswith(ending) and not one.asks)
    (tmp_path / foreign.name).write_bytes(foreign.data)
    with pytest.raises(RecordingSetError, match="at most 1000 are read"):
        read_unknown([tmp_path / foreign.name], None, foreign.known)


def test_conditions_in_grams_and_files_under_another_name_are_mapped(tmp_path: Path) -> None:
    (tmp_path / "run 1.csv").write_bytes(FILES["german excel, utf-8 mark"].data)
    (tmp_path / "trials.csv").write_text("Datei;load_g;mode\nrun 1.csv;120,5;slow\n")
    found, guess = read_unknown([tmp_path], None, FILES["plain"].known)
    assert guess is not None
    assert found.recordings[0].conditions == {"load_kg": pytest.approx(0.1205), "mode": "slow"}
    (tmp_path / "mapping.toml").write_text(mapping_text(guess.mapping), encoding="utf-8")
    again, _ = read_unknown([tmp_path], None, FILES["plain"].known)  # a set's own mapping is used
    assert again.recordings[0].conditions == found.recordings[0].conditions


@pytest.mark.parametrize("seed", range(60))
def test_damaged_at_random_a_file_is_read_or_refused_in_words(tmp_path: Path, seed: int) -> None:
    chance = random.Random(seed)
    foreign = FILES[chance.choice(list(FILES))]
    data = bytearray(foreign.data)
    for _ in range(chance.choice([1, 2, 5, 30])):
        place = chance.randrange(len(data) + 1)
        more = chance.choice([b"\n", b",", b'"', b"#", b"1e999", b"\xff", b"\0", bytes(data[:20]), b""])
        data[place : place + chance.choice([0, 1, 50])] = more
    (tmp_path / foreign.name).write_bytes(bytes(data))
    with suppress(RecordingSetError):  # any other error is a traceback that somebody would see
        read_unknown([tmp_path / foreign.name], None, foreign.known)


def test_an_infinite_time_is_refused_by_its_file(tmp_path):
    path = tmp_path / "endless.csv"
    rows = [f"{'-inf' if row == 0 else row / 100},{0.1 * row % 1},{0.2 + row % 3}" for row in range(200)]
    path.write_text("time_s,position_rad,current_a\n" + "\n".join(rows) + "\n", encoding="utf-8")
    with pytest.raises(RecordingSetError, match="endless"):
        read_unknown([path], Rig(name="endless"), Known({}))


def test_a_question_names_the_files_that_it_is_about(tmp_path: Path) -> None:
    degrees = next(one.data for one in FILES.values() if one.asks == "goes back and forth")
    folder = tmp_path / "arm"
    folder.mkdir()
    for number, place in enumerate((r"arm/a\.csv", r"arm/a\.csv and arm/b\.csv", r"arm/a\.csv and 2 more")):
        (folder / f"{'abc'[number]}.csv").write_bytes(degrees)
        with pytest.raises(RecordingSetError, match=rf"^{place}: .* goes back and forth"):
            read_unknown([folder], None, Known({}))
    with pytest.raises(RecordingSetError, match=r"^b\.csv: .* goes back and forth"):
        read_unknown([folder / "b.csv"], None, Known({}))


def test_what_an_import_refuses_is_asked_by_the_guess(tmp_path: Path) -> None:
    time_s = np.arange(400) * 0.01
    table = np.column_stack([time_s, np.sin(time_s), -np.cos(time_s), np.cos(time_s)])
    np.savetxt(tmp_path / "log.csv", table, "%.6f", ",", header="t,pos,vel,i", comments="")
    (question,) = guess_of([tmp_path / "log.csv"], None, Known({}))[0].questions
    assert re.search("an import refuses this: .*position_rad and velocity_rad_s have opposite signs", question)
    folder = tmp_path / "set"
    folder.mkdir()
    np.savetxt(folder / "log.csv", table[:, [0, 1, 3]], "%.6f", ",", header="t,pos,torque", comments="")
    (folder / "trials.csv").write_text("file,load_kg\nlog.csv,300\n")
    rig = Rig(name="arm", arm=Arm(length_m=0.3))
    with pytest.raises(RecordingSetError, match="load_kg is 300 kg"):
        read_unknown([folder], rig, Known({}))
    assert guess_of([folder], rig, Known({}))[0].questions == ()  # the mapping that is written then confirms it


def test_numbers_beyond_any_clock_are_no_time(tmp_path: Path) -> None:
    path = tmp_path / "large.csv"
    rows = [f"{(-1) ** i * 1.7e308 * (0.5 + i / 80)!r},{0.01 * i:g},0.5" for i in range(40)]
    path.write_text("\n".join(["time,position_rad,current_a", *rows]))
    with pytest.raises(RecordingSetError, match="no column is a time"):
        read_unknown([path], None, Known({}))


@pytest.mark.parametrize("size", [1e200, 1.7e308])
def test_numbers_beyond_any_quantity_do_not_tell_a_unit(tmp_path: Path, size: float) -> None:
    """Their squares, or even their steps, are more than a float holds; a warning would fail here."""
    path = tmp_path / "large.csv"
    rows = [f"{0.01 * i:g},{size if i % 7 == 3 else 2.9 * i!r},{(-1) ** i * size!r},0.5" for i in range(40)]
    path.write_text("\n".join(["time_s,position,speed,current_a", *rows]))
    with pytest.raises(RecordingSetError, match=r"large.*position_rad is 1.* rad in row 4, beyond"):
        read_unknown([path], None, Known({}))


@pytest.mark.parametrize(("kind", "bits"), [("f8", 0x7FF0000000000001), ("f4", 0x7F800001)])
def test_a_nan_that_signals_is_a_value_that_is_not_known(tmp_path: Path, kind: str, bits: int) -> None:
    """As a flipped bit spells one; a warning at the first sum would fail here."""
    time_s = 0.01 * np.arange(200)
    position = np.sin(time_s).astype(kind)
    position.view(kind.replace("f", "u"))[7] = bits
    np.savez(tmp_path / "signals.npz", time_s=time_s, position_rad=position, current_a=0.1 * np.cos(time_s))
    (recording,) = read_unknown([tmp_path / "signals.npz"], None, Known({}))[0].recordings
    assert np.flatnonzero(np.isnan(recording.channels["position_rad"])).tolist() == [7]


def test_what_was_written_as_a_recording_set_is_read_as_that_and_not_guessed(tmp_path):
    """A set, zipped or not, and one file of it; the few cells of events are no numbers."""
    time_s = np.arange(0.0, 2.0, 0.005)
    channels = {"time_s": time_s, "position_rad": np.sin(time_s), "current_estimate_a": np.cos(time_s)}
    made = Recording("swing", "sines", {"load_kg": 0.1}, channels, [Event(1.995, "end", "completed")])
    rig = Rig(name="mine", arm=Arm(length_m=0.3))
    for place in (tmp_path / "set", tmp_path / "set.zip"):
        write_recording_set(RecordingSet("set", rig, [made]), place)
        found, guess = read_unknown([place], None, Known({}))
        assert guess is None
        assert found.rig == rig
        assert found.recordings[0].conditions == {"load_kg": 0.1}
        assert list(found.recordings[0].channels) == list(channels)
        assert found.recordings[0].events == made.events
    alone, guess = read_unknown([tmp_path / "set" / "swing.csv"], rig, Known({}))
    assert guess is None
    assert alone.rig == rig
    assert list(alone.recordings[0].channels) == list(channels)
    columns = guess_of([tmp_path / "set"], None, Known({}))[0].taken
    assert next(one.why for one in columns if one.column == "event") == "events: they are kept"


@pytest.mark.parametrize(
    ("told", "counts"), [({"counts_per_turn": 100.0}, 5000.0), ({"counts_per_turn": 5000.0, "at": "joint"}, 5000.0)]
)
def test_counts_are_of_the_joint_wherever_the_sensor_turns(tmp_path: Path, told: dict, counts: float) -> None:
    time_s = np.arange(400) * 0.01
    path = tmp_path / "log.csv"
    table = np.column_stack([time_s, np.round(800.0 * np.sin(time_s)), np.cos(time_s)])
    np.savetxt(path, table, delimiter=",", header="time_s,encoder_counts,current_a", comments="")
    rig = Rig.model_validate({"name": "mine", "gear": {"ratio": 50.0}, "sensor": told})
    assert guess_of([path], rig, Known({}))[0].mapping.counts_per_turn == counts


@pytest.mark.parametrize("name", ["\x0e\x01time" * 3, "q" * 5000])
def test_a_name_that_damaged_bytes_spell_is_not_repeated_whole(name: str) -> None:
    with pytest.raises(RecordingSetError, match=r"a\.mat: has a name of \d+ characters .* save it again") as caught:
        column_table.table_of("a.mat", {name: np.arange(5.0), "t": np.arange(5.0)})
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("columns", "supply_v", "wanted"),
    [
        ({}, None, {"supply_v": 12.0}),
        ({}, 24.0, {"supply_v": 24.0}),  # what is said goes before
        ({"torque_n_m": np.cos(np.arange(400))}, None, {}),  # the duty is not needed
        ({"supply_v": 11.5}, None, {}),
    ],
)
def test_the_duty_takes_the_supply_of_the_rig(tmp_path: Path, columns: dict, supply_v: float | None, wanted) -> None:
    time_s = np.arange(400) * 0.01
    given = {"time_s": time_s, "position_rad": np.sin(time_s), "duty": 0.5 * np.cos(time_s)}
    given |= {name: np.broadcast_to(value, 400) for name, value in columns.items()}
    path = tmp_path / "log.csv"
    np.savetxt(path, np.column_stack(list(given.values())), delimiter=",", header=",".join(given), comments="")
    rig = Rig.model_validate({"name": "mine", "supply": {"voltage_v": 12.0}})
    guess, _, _ = guess_of([path], rig, Known({}, supply_v=supply_v))
    assert not guess.questions
    assert guess.mapping.constants == wanted
    assert ("the supply is 12 V throughout" in " ".join(guess.notes)) == (wanted == {"supply_v": 12.0})
    if not columns and supply_v is None:
        assert "[supply] voltage_v = 12" in guess_of([path], None, Known({}))[0].questions[0]
