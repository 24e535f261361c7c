"""The table of channels: what it says is what is recorded, kept, exported and told."""

from dataclasses import replace

import numpy as np
import pytest

from bench.config.channels import CHANNELS, JOINT_CHANNELS, PAIR_RECORDED, RECORDED, exported, known_to_lab
from bench.config.quantities import unit_of
from bench.control.cycle import VALUES, Action, Reading, row_of, row_reader
from bench.recording_set.stream import stream_of_trial
from bench.store import Store
from compensator.lab.recordings.recording import CHANNELS as LAB_CHANNELS
from drivers.contract import Command, Mode, Sample, Status

SAMPLE = Sample(7.0, 0.01, 0.5, 0.6, 0.7, 0.8, 24.0, 30.0, Status.ENABLED)
ACTION = Action(Command(Mode.CURRENT, 0.3), 0.4, 0.2, ("mark", ""), 0.05)
READING = Reading(2.0, SAMPLE, 0.61, 0.81, 0.82)


def test_each_channel_of_a_row_is_what_the_table_says():
    row = dict(zip(RECORDED, row_of(ACTION, READING), strict=True))
    told = {
        "time_s": 2.0,
        "target_rad": 0.4,
        "position_rad": 0.5,
        "velocity_rad_s": 0.61,
        "duty": 0.7,
        "current_a": 0.8,
        "current_estimate_a": 0.82,
        "current_command_a": 0.3,
        "current_load_a": 0.2,
        "current_load_half_width_a": 0.05,
        "supply_v": 24.0,
        "temperature_c": 30.0,
        "enabled": 1.0,
        "age_s": 0.01,
    }
    assert {name: row[name] for name in told} == told


def test_a_duty_is_no_current_that_was_asked_for():
    row = dict(zip(RECORDED, row_of(Action(Command(Mode.DUTY, 0.3)), READING), strict=True))
    assert np.isnan(row["current_command_a"])


def test_a_channel_that_reads_what_there_is_not_is_refused_with_what_there_is():
    with pytest.raises(ValueError, match=r"time_s reads 'reading.time_s'; known are action.command"):
        row_reader(JOINT_CHANNELS[:1], [name for name in VALUES if name.startswith("action.")])


def test_the_unit_is_that_of_the_name():
    assert {channel.unit for channel in CHANNELS.values() if not unit_of(channel.name)} == {"1"}
    assert all(channel.unit == (unit_of(channel.name) or "1") for channel in CHANNELS.values())


def test_the_lab_understands_what_is_exported_as_the_bench_does():
    assert set(known_to_lab(exported(PAIR_RECORDED))) == set(exported(PAIR_RECORDED))
    for name in known_to_lab(PAIR_RECORDED):
        assert (CHANNELS[name].unit, CHANNELS[name].description) == (
            LAB_CHANNELS[name].unit,
            LAB_CHANNELS[name].meaning,
        )


def test_a_channel_that_only_the_bench_knows_is_kept_and_left_out_of_what_is_exported(tmp_path, monkeypatch):
    monkeypatch.setitem(CHANNELS, "duty", replace(CHANNELS["duty"], exported=False))
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        writer = store.begin_trial(store.begin_experiment("steps", {}, "simulated", {}, {}), "a", "steps", {}, RECORDED)
        rows = np.arange(3.0)[:, None] + np.arange(float(len(RECORDED)))
        writer.append(rows)
        trial = store.trial(writer.trial_id)
        stream = stream_of_trial(store, trial)
        assert "duty" not in stream.channels
        (piece,) = stream.pieces()
        columns = [RECORDED.index(name) for name in stream.channels]
        np.testing.assert_array_equal(piece.columns, rows[:, columns].T)
        np.testing.assert_array_equal(store.samples(trial.id)["duty"], rows[:, RECORDED.index("duty")])
