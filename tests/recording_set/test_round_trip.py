"""What is written reads back: store -> folder or zip -> store, the same bits."""

import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bench.config.rig import Arm, Effort, Gear, Motor, Rig
from bench.recording_set import (
    RecordingSet,
    RecordingSetError,
    export_experiment,
    import_recording_set,
    read_recording_set,
    write_recording_set,
)
from bench.recording_set.transfer import CONTROL_LOOP
from bench.store import Store
from compensator.lab.recordings.recording import CHANNELS, Event, Recording
from tests.recording_set.test_values import CONDITIONS

RIG = Rig(
    name='bench "3"',
    motor=Motor(name="m", resistance_ohm=0.1 + 0.2),
    gear=Gear(backlash_rad=0.0),
    arm=Arm(length_m=1e-17),
    effort=Effort(quantity="current"),
)
CHARACTERS = st.characters(codec="utf-8", exclude_characters="\0")  # a database has no place for NUL
NAMES = st.text(CHARACTERS, min_size=1, max_size=12)
KEYS = st.text(CHARACTERS, max_size=8).map(lambda text: f"k{text}k").filter(str.isprintable)


@st.composite
def recordings(draw: st.DrawFn, name: str) -> Recording:
    time_s = draw(st.lists(st.floats(-1e9, 1e9), min_size=2, max_size=12, unique=True).map(sorted))
    others = draw(st.lists(st.sampled_from([key for key in CHANNELS if key != "time_s"]), min_size=1, unique=True))
    # NaN is not measured; infinite is nothing that a sensor gives, and is refused
    numbers = st.lists(st.floats(allow_infinity=False), min_size=len(time_s), max_size=len(time_s))
    channels = {"time_s": np.array(time_s)} | {key: np.array(draw(numbers)) for key in others}
    for values in channels.values():
        values[np.isnan(values)] = np.nan  # one NaN: CSV has no payloads
    texts = st.text(CHARACTERS, max_size=6)
    times = st.one_of(st.sampled_from(time_s), st.floats(-1e9, 1e9))
    events = draw(st.lists(st.builds(Event, times, texts, texts), max_size=4))
    events.sort(key=lambda event: event.time_s)
    return Recording(name, draw(texts), draw(st.dictionaries(KEYS, CONDITIONS, max_size=3)), channels, events)


SETS = st.lists(NAMES, min_size=1, max_size=3, unique=True).flatmap(
    lambda names: st.tuples(*(recordings(name) for name in names))
)


def assert_same(found: list[Recording], expected: list[Recording]) -> None:
    assert [recording.name for recording in found] == [recording.name for recording in expected]
    for one, other in zip(found, expected, strict=True):
        assert (one.kind, one.conditions, one.events) == (other.kind, other.conditions, other.events)
        assert {key: type(value) for key, value in one.conditions.items()} == {
            key: type(value) for key, value in other.conditions.items()
        }
        assert list(one.channels) == list(other.channels)
        for name, values in other.channels.items():
            assert one.channels[name].tobytes() == values.tobytes(), name


@settings(max_examples=60)
@given(SETS, st.sampled_from(["set", "set.zip"]))
def test_every_set_reads_back_as_itself(found: tuple[Recording, ...], name: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        write_recording_set(RecordingSet("set", RIG, list(found)), path)
        back = read_recording_set(path)
        assert back.rig == RIG
        assert_same(back.recordings, list(found))


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(SETS, st.sampled_from(["set", "set.zip"]))
def test_the_store_gives_back_what_it_was_given(store: Store, found: tuple[Recording, ...], name: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        first = import_recording_set(store, RecordingSet("set", RIG, list(found)), "drawn")
        export_experiment(store, first, Path(folder) / name)
        again = import_recording_set(store, read_recording_set(Path(folder) / name), "again")
    for experiment_id in (first, again):
        trials = store.trials(experiment_id)
        back = [
            Recording(trial.name, trial.kind, trial.conditions, store.samples(trial.id), store.events(trial.id))
            for trial in trials
        ]
        assert_same(back, list(found))
        assert store.experiment(experiment_id).rig == RIG.model_dump(mode="json", exclude_none=True)


def measured(store: Store) -> int:
    """An experiment with a completed, a stopped and a refused trial."""
    experiment_id = store.begin_experiment("steps", {"seed": 4}, "simulated", {"plant": "truth"}, {"name": "paper"})
    for name, outcome, rows in (("a", "completed", 3), ("b / 90°", "stopped", 2), ("c", "refused", 0)):
        writer = store.begin_trial(experiment_id, name, "step", {"load_kg": 0.1}, ("time_s", "duty"))
        writer.append(np.arange(2.0 * rows).reshape(rows, 2))
        writer.finish(outcome, "stop was pressed" if outcome == "stopped" else "", {"hidden": "truth"})
    store.finish_experiment(experiment_id, "completed", "", {"hidden": "truth"})
    return experiment_id


def test_an_import_says_where_it_came_from_and_how_trials_ended(store: Store, tmp_path: Path) -> None:
    export_experiment(store, measured(store), tmp_path / "out.zip")
    experiment_id = import_recording_set(store, read_recording_set(tmp_path / "out.zip"), "from bench 3")
    found = store.experiment(experiment_id)
    assert (found.kind, found.source, found.outcome) == ("import", "imported", "completed")
    assert found.parameters == {"name": "from bench 3", "recording_set": "out", CONTROL_LOOP: "yes"}
    assert all("recorded_by" not in trial.conditions for trial in store.trials(experiment_id))
    assert found.provenance["software"]["version"]
    trials = store.trials(experiment_id)
    assert [(trial.name, trial.outcome, trial.reason) for trial in trials] == [
        ("a", "completed", ""),
        ("b / 90°", "stopped", "stop was pressed"),
    ]
    assert all(trial.conditions == {"load_kg": 0.1} for trial in trials)


def test_an_export_carries_the_rig_and_nothing_of_the_truth(store: Store, tmp_path: Path) -> None:
    export_experiment(store, measured(store), tmp_path / "out")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "a.csv",
        "b___90_.csv",
        "rig.toml",
        "trials.csv",
    ]
    assert "truth" not in "".join(path.read_text() for path in (tmp_path / "out").iterdir())
    assert (tmp_path / "out" / "rig.toml").read_text() == 'name = "paper"\njoint = "rotary"\nhorizontal = false\n'


def test_the_same_experiment_makes_the_same_zip(store: Store, tmp_path: Path) -> None:
    experiment_id = measured(store)
    for name in ("a.zip", "b.zip"):
        export_experiment(store, experiment_id, tmp_path / name)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()


def test_an_import_that_fails_leaves_nothing(store: Store) -> None:
    good = Recording("a", "step", {}, {"time_s": np.arange(3.0), "duty": np.zeros(3)})
    bad = Recording("b", "step", {"load_kg": float("nan")}, {"time_s": np.arange(3.0), "duty": np.zeros(3)})
    with pytest.raises(ValueError, match="condition 'load_kg' is nan"):
        import_recording_set(store, RecordingSet("set", RIG, [good, bad]), "half")
    assert store.experiments() == []
    assert store.trials() == []


def test_what_is_there_already_is_not_overwritten(store: Store, tmp_path: Path) -> None:
    experiment_id = measured(store)
    for name in ("out", "out.zip"):
        export_experiment(store, experiment_id, tmp_path / name)
        with pytest.raises(RecordingSetError, match="is there already; name another place"):
            export_experiment(store, experiment_id, tmp_path / name)
    (tmp_path / "empty").mkdir()
    export_experiment(store, experiment_id, tmp_path / "empty")


def test_an_export_that_fails_leaves_nothing(store: Store, tmp_path: Path) -> None:
    experiment_id = store.begin_experiment("steps", {}, "real", {}, {"name": "paper"})
    writer = store.begin_trial(experiment_id, "a", "step", {"rows": 3.0}, ("time_s", "duty"))
    writer.append(np.arange(6.0).reshape(3, 2))
    for name in ("out", "out.zip"):
        with pytest.raises(RecordingSetError, match="a condition cannot be called 'rows'"):
            export_experiment(store, experiment_id, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir() if "out" in path.name] == []


def test_an_experiment_without_rows_is_not_written(store: Store, tmp_path: Path) -> None:
    experiment_id = store.begin_experiment("steps", {}, "real", {}, {"name": "paper"})
    with pytest.raises(RecordingSetError, match=f"experiment {experiment_id}: has no trial of at least 2 rows"):
        export_experiment(store, experiment_id, tmp_path / "out")


def test_names_that_files_cannot_have_are_kept(tmp_path: Path) -> None:
    names = ["trials", "A", "a", "../x", ".hidden", "x" * 300, "0.1 kg / 90°", "ü", "ö", "a.csv"]
    channels = {"time_s": np.arange(2.0), "duty": np.zeros(2)}
    found = [Recording(name, "step", {}, dict(channels)) for name in names]
    write_recording_set(RecordingSet("set", RIG, found), tmp_path / "set")
    files = [path.name for path in (tmp_path / "set").iterdir()]
    assert len({file.lower() for file in files}) == len(names) + 2
    assert all(file.isascii() and len(file) < 120 and not file.startswith(".") for file in files)
    assert [recording.name for recording in read_recording_set(tmp_path / "set").recordings] == names


def test_a_full_disk_is_reported(store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("bench.recording_set.write.csv_chunks", full)
    with pytest.raises(RecordingSetError, match="cannot be written: No space left on device"):
        export_experiment(store, measured(store), tmp_path / "out")
    assert not (tmp_path / "out").exists()
    shutil.rmtree(tmp_path)


def test_no_name_of_a_condition_nor_event_is_run_as_a_formula(tmp_path: Path) -> None:
    channels = {"time_s": np.arange(2.0), "duty": np.zeros(2)}
    events = [Event(0.0, "=1+1", "x"), Event(1.0, "'@sum", "")]
    found = [Recording("a", "step", {"=2+2": 1.0, "+x": "-y"}, channels, events)]
    write_recording_set(RecordingSet("set", RIG, found), tmp_path / "set")
    for file in ("trials.csv", "a.csv"):
        cells = (tmp_path / "set" / file).read_text().replace("\n", ",").split(",")
        assert not [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]
    assert_same(read_recording_set(tmp_path / "set").recordings, found)
