"""Measured sets of other benches, read with the rigs and mappings under examples/."""

import time
from pathlib import Path

import numpy as np
import pytest

from bench.recording_set import (
    RecordingSet,
    export_experiment,
    import_recording_set,
    read_mapping,
    read_recording_set,
    read_rig,
)
from bench.store import Store
from tests.paths import EXAMPLES, measured


def read(name: str) -> RecordingSet:
    example = EXAMPLES / name
    return read_recording_set(measured(name), read_mapping(example / "mapping.toml"), read_rig(example / "rig.toml"))


def test_emps() -> None:
    found = read("emps")
    assert (found.rig.joint, found.rig.horizontal) == ("linear", True)
    assert [(recording.name, recording.kind) for recording in found.recordings] == [
        ("reference", "reference"),
        ("pulses", "pulses"),
    ]
    reference = found.recordings[0]
    assert len(reference) == 24_841
    assert set(reference.channels) == {"time_s", "target_m", "position_m", "force_n"}
    assert reference.channels["force_n"][0] == 2.53862809 * 35.15065


def test_xl330() -> None:
    found = read("xl330")
    assert found.rig.arm.length_m == 0.10
    assert len(found.recordings) == 16
    assert {recording.kind for recording in found.recordings} == {
        "lift_and_drop",
        "sin_sin",
        "sin_time_square",
        "up_and_down",
    }
    for recording in found.recordings:
        assert recording.conditions == {
            "trajectory": recording.kind,
            "kp": float(recording.name.partition("kp")[2]),
            "load_kg": 0.49,
            "arm_m": 0.1,
        }
        assert set(np.unique(recording.channels["enabled"])) <= {0.0, 1.0}
    assert any(np.any(recording.channels["enabled"] == 0.0) for recording in found.recordings)


def test_sts3215_goes_through_the_store_and_back_in_seconds(store: Store, tmp_path: Path) -> None:
    started = time.monotonic()
    found = read("sts3215")
    assert time.monotonic() - started < 15.0  # well under 1 s when nothing else runs
    assert len(found.recordings) == 320
    assert sum(map(len, found.recordings)) == 191_781
    assert {recording.conditions["load_kg"] for recording in found.recordings} == {0.535, 0.74117693, 0.969, 1.1682}
    experiment_id = import_recording_set(store, found, "sts3215")
    assert len(store.trials(experiment_id, conditions={"load_kg": (1.0, 2.0), "kp": 32})) == 20
    export_experiment(store, experiment_id, tmp_path / "out.zip")
    back = read_recording_set(tmp_path / "out.zip")
    for one, other in zip(back.recordings, found.recordings, strict=True):
        assert (one.name, one.kind, one.conditions) == (other.name, other.kind, other.conditions)
        assert all(np.array_equal(one.channels[name], values) for name, values in other.channels.items())


def test_without_a_mapping_the_unknown_column_is_named() -> None:
    folder = measured("xl330")
    with pytest.raises(ValueError, match=r"column 'torque_enabled': is no known channel. is enabled meant\?"):
        read_recording_set(folder, None, read_rig(EXAMPLES / "xl330" / "rig.toml"))
