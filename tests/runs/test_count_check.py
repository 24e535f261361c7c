"""A count that was reset by a power cycle is noticed before anything moves; a person says whether it is right."""

import json
import time
from datetime import timedelta
from math import degrees, pi

import numpy as np
import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.config.drives.real import HomingSettings
from bench.control.cycle import OFF
from bench.control.drive_factory import make_equipment
from bench.provenance import provenance
from bench.runs import count_check
from bench.runs.count_check import count_doubt
from bench.runs.runner import Runner
from bench.store import Store
from tests.drivers.conformance.benches import PERIOD_S
from tests.stopping.bench import PARAMETERS, kills_bench

pytestmark = [pytest.mark.wall_clock, pytest.mark.timeout(180)]


@pytest.fixture
def bench(tmp_path, monkeypatch):
    monkeypatch.setattr(count_check, "GAP", timedelta(0.0))
    with kills_bench(tmp_path) as found:
        yield found


@pytest.fixture
def store(bench):
    with Store.open(bench.records.url) as opened:
        yield opened


def drive_of(configuration):
    """The drive as it is now: its description, and where the joint stands by its count."""
    drive = make_equipment(configuration).drive
    drive.open(PERIOD_S)
    try:
        return drive.describe(), drive.exchange(OFF).position_rad
    finally:
        drive.close()


def ended_at(store, configuration, found, *positions_rad):
    """An experiment whose arm stood there, at its end in the last place."""
    made = store.begin_experiment("steps", {}, "simulated", provenance(configuration, found), {})
    writer = store.begin_trial(made, "step", "steps", {}, ("time_s", "position_rad"))
    writer.append(np.array([[0.01 * place, one] for place, one in enumerate(positions_rad)]))
    writer.finish("completed", "", {})
    store.finish_experiment(made, "completed")
    return made


def doubt(store, configuration, found, position_rad):
    return count_doubt(store, configuration, found, lambda: position_rad)


def test_what_the_records_and_the_count_say_together(bench, store):
    configuration = bench.configuration
    found, now_rad = drive_of(configuration)
    assert now_rad == 0.0
    assert doubt(store, configuration, found, 0.0) == ""  # nothing was measured with it yet
    ended_at(store, configuration, found, 0.5, 0.05)
    assert doubt(store, configuration, found, 0.0) == ""  # it hung there before, too
    made = ended_at(store, configuration, found, 0.0, 1.4)
    said = doubt(store, configuration, found, 0.0)
    assert f"80 degrees at the end of experiment {made}" in said
    assert "doctor --set-zero" in said
    assert doubt(store, configuration, found, 0.01) == ""  # a count that goes on from where it was is not 0


def test_an_absolute_encoder_that_has_lost_count_of_its_turns(bench, store):
    drive = bench.configuration.drive.model_copy(update={"homing": HomingSettings(method="absolute")})
    configuration = bench.configuration.model_copy(update={"drive": drive})
    found, _ = drive_of(configuration)
    turn_rad = 2.0 * pi / configuration.rig.gear.ratio
    made = ended_at(store, configuration, found, 0.0, 0.2)
    said = doubt(store, configuration, found, 0.2 + 2.0 * turn_rad + 0.002)
    assert f"off by 2 whole motor turns ({degrees(2.0 * turn_rad):.0f} degrees" in said
    assert f"experiment {made}" in said
    assert "off by -1 whole" in doubt(store, configuration, found, 0.2 - turn_rad)
    assert doubt(store, configuration, found, 0.2) == ""
    assert doubt(store, configuration, found, 0.2 + 0.5 * turn_rad) == ""  # somebody has moved the arm
    assert doubt(store, configuration, found, 0.0) == ""  # a count of 0 is no news of it


def test_a_zero_that_was_set_since_or_an_experiment_of_just_now_leaves_no_doubt(bench, store, monkeypatch):
    configuration = bench.configuration
    found, _ = drive_of(configuration)
    ended_at(store, configuration, found, 1.4)
    zeroed = configuration.model_copy(update={"drive": configuration.drive.model_copy(update={"zero_rad": -1.4})})
    assert doubt(store, zeroed, found, 1.4) == ""
    monkeypatch.setattr(count_check, "GAP", timedelta(seconds=20.0))
    assert doubt(store, configuration, found, 0.0) == ""


def test_nothing_moves_before_a_person_has_looked(bench, store):
    found, _ = drive_of(bench.configuration)
    ended_at(store, bench.configuration, found, 1.4)
    runner = Runner(bench.configuration, store)
    try:
        started = runner.start("excitation", PARAMETERS)
        prompt = _prompt(runner)
        assert "as after its supply was switched off and on" in prompt.sentence
        time.sleep(0.3)
        assert bench.device.truth()["powered"] is False
        runner.stop("it does not")
        assert runner.wait(30.0)
        assert store.experiment(started).outcome == "stopped"
        assert store.trials(started) == []
        runner.start("excitation", PARAMETERS)
        runner.answer(_prompt(runner).number)
        bench.wait_for_power(True)
    finally:
        runner.close()


def test_doctor_says_it(bench, store):
    found, _ = drive_of(bench.configuration)
    said = _doctor(bench)
    assert said["count_doubt"] == ""
    made = ended_at(store, bench.configuration, found, 1.4)
    assert f"at the end of experiment {made}" in _doctor(bench)["count_doubt"]


def _doctor(bench):
    options = ["--config", str(bench.folder / "bench.toml"), "--store", bench.records.url]
    ran = CliRunner().invoke(app, [*options, "doctor", "--json"])
    assert ran.exit_code == 0, ran.output
    return json.loads(ran.stdout)


def _prompt(runner):
    end_s = time.monotonic() + 20.0
    while (found := runner.status().prompt) is None:
        assert time.monotonic() < end_s, runner.status()
        time.sleep(0.01)
    return found
