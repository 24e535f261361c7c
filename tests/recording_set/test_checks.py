"""What is looked at before recordings are kept: values outside physics, position, effort, wraps."""

from pathlib import Path

import numpy as np
import pytest

from bench.recording_set import Mapping, RecordingSetError, read_recording_set
from bench.recording_set.mapping import Column
from tests.recording_set.examples import write_set
from tests.recording_set.foreign_files import CURRENT_A, POSITION_RAD, TIME_S, TURNING_RAD, VELOCITY_RAD_S, rows

GOOD = {"time_s": TIME_S, "position_rad": POSITION_RAD, "current_a": CURRENT_A}
CONSTANT = np.ones(len(TIME_S))

# what is wrong: the columns, and what the message must say
ASKED = {
    "position in degrees": ({"position_rad": np.degrees(POSITION_RAD)}, "Is the column in degrees?"),
    "duty of 50": ({"duty": 50.0 * CURRENT_A}, "duty reaches"),
    "supply of 24000": ({"supply_v": 24e3 * CONSTANT}, "supply_v reaches 24000 V; possible is"),
    "current in milliamperes": ({"current_a": 3000.0 * CURRENT_A}, "Is the column in mA?"),
    "temperature in kelvin": ({"temperature_c": 300.0 * CONSTANT}, "Is the column in K?"),
    "time in milliseconds": ({"time_s": 1e3 * TIME_S}, "samples a second; possible is"),
    "a wrap": ({"position_rad": (9.0 * TURNING_RAD) % 25.0}, "every 25 rad; unwrap it in a mapping (period = 25"),
    "no position": ({"position_rad": None}, "no trial has position_rad"),
    "a linear joint": ({"position_rad": None, "position_m": POSITION_RAD}, 'say joint = "linear" in the rig'),
    "no effort": ({"current_a": None}, "has no effort channel"),
    "speed of another unit": ({"velocity_rad_s": np.degrees(VELOCITY_RAD_S)}, "0.0174 for velocity_rad_s, 57.3 for"),
}  # fmt: skip


def set_of(tmp_path: Path, **changes: np.ndarray | None) -> Path:
    columns = {name: values for name, values in {**GOOD, **changes}.items() if values is not None}
    return write_set(tmp_path / "set", {"run.csv": rows(columns)})


@pytest.mark.parametrize("what", ASKED)
def test_what_cannot_be_is_asked_about_before_anything_is_kept(tmp_path: Path, what: str) -> None:
    changes, words = ASKED[what]
    with pytest.raises(RecordingSetError) as caught:
        read_recording_set(set_of(tmp_path, **changes))
    assert words in str(caught.value)


def test_what_can_be_comes_in(tmp_path: Path) -> None:
    turning = set_of(tmp_path, position_rad=60.0 * TURNING_RAD)  # on and on, one way
    assert len(read_recording_set(turning).recordings[0]) == len(TIME_S)


RIG = """name = "arm"
motor = { torque_constant_n_m_a = 0.05, resistance_ohm = 8 }
gear = { ratio = 20 }
arm = { length_m = 0.3 }
"""
VOLTAGE = {"current_a": None, "duty": 0.5 * CURRENT_A, "supply_v": 12.0 * CONSTANT}


def loaded_set(tmp_path: Path, load_kg: float, more: str = "", **changes: np.ndarray | None) -> Path:
    folder = set_of(tmp_path, **changes)
    titles, values = (",balanced", ",true") if more == "balanced" else ("", "")
    (folder / "trials.csv").write_text(f"file,load_kg{titles}\nrun.csv,{load_kg}{values}\n", encoding="utf-8")
    (folder / "rig.toml").write_text(("horizontal = true\n" if more == "horizontal" else "") + RIG, encoding="utf-8")
    return folder


@pytest.mark.parametrize("changes", [{}, VOLTAGE, {"current_a": None, "torque_n_m": CURRENT_A}])
def test_a_load_that_no_effort_carries_is_asked_about(tmp_path: Path, changes: dict[str, np.ndarray | None]) -> None:
    with pytest.raises(RecordingSetError, match=r"load_kg is 300 kg.*Is it in g"):
        read_recording_set(loaded_set(tmp_path, 300.0, **changes))
    grams = Mapping(trials_columns={"load_kg": {"from": "load_kg", "scale": 0.001}})
    assert read_recording_set(tmp_path / "set", grams).recordings[0].conditions["load_kg"] == pytest.approx(0.3)
    sure = Mapping(trials_columns={"load_kg": {"from": "load_kg"}})
    assert read_recording_set(tmp_path / "set", sure).recordings[0].conditions["load_kg"] == 300.0


def test_a_load_that_a_mapping_tells_is_asked_about_too(tmp_path: Path) -> None:
    folder = set_of(tmp_path)
    (folder / "rig.toml").write_text(RIG, encoding="utf-8")
    told = {"trials": [{"file": "run.csv", "conditions": {"load_kg": 300.0}}]}
    with pytest.raises(RecordingSetError, match=r"Correct it in \[\[trials\]\]"):
        read_recording_set(folder, Mapping.model_validate(told))
    sure = Mapping.model_validate(told | {"trials_columns": {"load_kg": {"from": "load_kg"}}})
    assert read_recording_set(folder, sure).recordings[0].conditions["load_kg"] == 300.0


@pytest.mark.parametrize(
    ("load_kg", "more", "changes"),
    [
        (0.3, "", {}),
        (3.0, "", {}),  # a spring may carry most of it
        (300.0, "balanced", {}),
        (300.0, "horizontal", {}),
        (300.0, "", {"position_rad": 1e-3 * POSITION_RAD}),  # it hardly moves: a brake may hold it
    ],
)
def test_a_load_that_may_be_is_taken(
    tmp_path: Path, load_kg: float, more: str, changes: dict[str, np.ndarray | None]
) -> None:
    folder = loaded_set(tmp_path, load_kg, more, **changes)
    assert read_recording_set(folder).recordings[0].conditions["load_kg"] == load_kg


def test_trials_that_do_not_tell_their_load_are_noted(tmp_path: Path) -> None:
    assert [note for note in read_recording_set(set_of(tmp_path)).notes if "no trial tells load_kg" in note]
    loaded = loaded_set(tmp_path, 0.3)
    assert read_recording_set(loaded).notes == ()
    (loaded / "second.csv").write_bytes((loaded / "run.csv").read_bytes())
    (loaded / "trials.csv").write_text("file,load_kg\nrun.csv,0.3\nsecond.csv,\n", encoding="utf-8")
    assert "1 of 2 trials do not tell load_kg" in read_recording_set(loaded).notes[0]


def test_a_unit_that_is_stated_confirms_a_value(tmp_path: Path) -> None:
    folder = set_of(tmp_path, position_rad=np.degrees(POSITION_RAD))
    for unit, factor in (("rad", 1.0), ("deg", np.pi / 180.0)):
        mapping = Mapping(columns={"position_rad": Column(source="position_rad", unit=unit)})
        found = read_recording_set(folder, mapping).recordings[0].channels["position_rad"]
        np.testing.assert_allclose(found, factor * np.degrees(POSITION_RAD), atol=1e-6)


def test_a_wrap_of_any_period_is_taken_back_by_the_mapping(tmp_path: Path) -> None:
    folder = set_of(tmp_path, position_rad=(9.0 * TURNING_RAD) % 25.0)
    mapping = Mapping(columns={"position_rad": Column(source="position_rad", period=25.0)})
    found = read_recording_set(folder, mapping).recordings[0].channels["position_rad"]
    np.testing.assert_allclose(found, 9.0 * TURNING_RAD, atol=1e-5)
