"""`friction-bench run`, `experiments`, `trials`, `trial`."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from bench.store import Store
from bench.store.errors import StoreFullError


def test_a_run_and_what_is_listed_afterwards(command):
    ran = command("run", "steps", "--repeats", 2, "--load-kg", 0.05, "--operator", "R. Saini", "--json")
    assert ran.exit_code == 0, ran.output
    record = json.loads(ran.stdout)
    assert record["outcome"] == "completed"
    assert record["operator"] == "R. Saini"
    assert record["parameters"]["load_kg"] == 0.05
    assert record["results"]["mean_reflected_load_kg"] == pytest.approx(0.05, abs=0.005)
    listed = json.loads(command("experiments", "--json").stdout)
    assert [one["experiment_id"] for one in listed] == [record["experiment_id"]]
    trials = json.loads(command("trials", "--experiment", record["experiment_id"], "--json").stdout)
    assert [one["name"] for one in trials] == ["step-001", "step-002"]
    trial = json.loads(command("trial", trials[0]["trial_id"], "--json").stdout)
    assert trial["events"][-1]["name"] == "end"
    rows = command("trial", trials[0]["trial_id"], "--csv").stdout.splitlines()
    assert rows[0].startswith("time_s,target_rad,position_rad")
    assert len(rows) == trial["rows"] + 1


def test_plain_lines_where_there_is_no_terminal(command):
    shown = command("run", "steps", "--repeats", 1).stdout
    assert "steps: 1 trials, about " in shown
    assert "steps: trial 1 of 1" in shown
    assert "experiment 1: completed" in shown
    assert "\x1b" not in shown


def test_every_parameter_is_an_option_with_unit_and_default(command):
    shown = command("run", "load-sweep", "--help").output
    for word in ("--loads-kg", "--angles-rad", "--repeats", "[kg]", "[rad]", "Default: 1", "--operator", "--json"):
        assert word in shown, word


def test_lists_are_separated_by_commas(command):
    ran = command("run", "load-sweep", "--loads-kg", "0,0.05", "--angles-rad", "1.57", "--json")
    assert ran.exit_code == 0, ran.output
    assert json.loads(ran.stdout)["parameters"]["loads_kg"] == [0.0, 0.05]
    one_by_one = ["--loads-kg", "0", "--loads-kg", "0.05"]
    ran = command("run", "load-sweep", *one_by_one, "--angles-rad", "1.57", "--json")
    assert json.loads(ran.stdout)["parameters"]["loads_kg"] == [0.0, 0.05]


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["run", "steps", "--load-kg", "5"], 3, "load_kg is 5 kg; allowed is at most 0.1 kg"),
        (["run", "steps", "--repeats", "many"], 3, "repeats: found 'many'"),
        (["run", "steps", "--repeats", "1", "--repeats", "2"], 2, "repeats is given 2 times, as 1, 2; give one value"),
        (["run", "dance"], 2, "known are steps"),
        (["run", "steps", "--speed", "1"], 2, "No such option"),
        (["trial", "7"], 3, "trial 7 is not in the store"),
        (["trials", "--experiment", "7"], 3, "experiment 7 is not in the store"),
        (["--config", "missing.toml", "experiments"], 3, "missing.toml"),
        (["--store", "", "experiments"], 3, "--store is empty"),
        (["--store", "no/such/folder/bench.sqlite", "experiments"], 3, "no/such/folder"),
        (["status", "--url", "http://127.0.0.1:9"], 5, "does not answer"),
        (["stop", "--url", "nonsense"], 5, "does not answer"),
    ],
)
def test_errors_are_one_message_and_a_documented_code(command, words, code, message):
    result = command(*words)
    assert result.exit_code == code, result.output
    assert message in " ".join(result.stderr.replace("│", " ").split())
    assert "Traceback" not in result.output


def test_the_exit_codes_are_in_the_help(command):
    shown = command("--help").output
    for word in ("Exit codes", "FRICTION_BENCH_STORE", "FRICTION_BENCH_TOKEN", "130"):
        assert word in shown


def test_the_store_is_chosen_by_option_and_by_environment(command, monkeypatch, tmp_path):
    assert command("--store", "a.sqlite", "experiments").exit_code == 0
    monkeypatch.setenv("FRICTION_BENCH_STORE", "sqlite:///b.sqlite")
    assert command("experiments").exit_code == 0
    assert (tmp_path / "a.sqlite").is_file()
    assert (tmp_path / "b.sqlite").is_file()
    assert not (tmp_path / "friction-bench.sqlite").exists()


def wait_for_rows(path, count):
    """Until so many rows are committed: a loaded machine takes its time to start a loop."""
    deadline_s = time.monotonic() + 60.0
    with Store.open(f"sqlite:///{path}") as store:
        while not any(trial.rows >= count for trial in store.trials()):
            assert time.monotonic() < deadline_s
            time.sleep(0.02)


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("number", "times", "code"), [(signal.SIGINT, 2, 130), (signal.SIGTERM, 1, 143), (signal.SIGHUP, 1, 143)]
)
def test_a_signal_stops_the_joint_and_is_recorded(tmp_path, number, times, code):
    words = [sys.executable, "-m", "bench.cli", "run", "steps", "--pace", "real-time"]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert "steps: 25 trials, about " in process.stdout.readline()
        assert "trial 1 of 25" in process.stdout.readline()
        wait_for_rows(tmp_path / "friction-bench.sqlite", 21)
        for _ in range(times):
            process.send_signal(number)
        assert process.wait(30.0) == code
        assert "Traceback" not in (process.stderr.read() if process.stderr else "")
    with Store.open(f"sqlite:///{tmp_path / 'friction-bench.sqlite'}") as store:
        [experiment] = store.experiments()
        [trial] = store.trials(experiment.id)
    assert experiment.outcome == trial.outcome == "stopped"
    names = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM", signal.SIGHUP: "the terminal was closed"}
    assert names[number] in experiment.reason
    assert trial.rows > 20


def test_a_run_whose_record_cannot_be_closed_says_why_all_the_same(command, monkeypatch):
    def full(*_args, **_kwargs):
        raise StoreFullError("the disk is full")

    monkeypatch.setattr(Store, "finish_experiment", full)
    result = command("run", "steps", "--repeats", "1")
    assert result.exit_code == 1
    assert "experiment 1: failed: the record could not be closed: the disk is full" in result.output


def test_a_waveform_is_a_file_on_the_command_line(command, tmp_path):
    file = tmp_path / "swing.csv"
    file.write_text("t_s,current_a\n0,0\n0.5,0.15\n1,0\n", encoding="utf-8")
    ran = command("run", "waveform", "--csv", file, "--json")
    assert ran.exit_code == 0, ran.output
    assert json.loads(ran.stdout)["parameters"]["source"] == "swing.csv"
    file.write_text("t_s,current_a\n0,0\n0.5,much\n", encoding="utf-8")
    wrong = command("run", "waveform", "--csv", file)
    assert wrong.exit_code == 3
    assert "swing.csv, line 3, column current_a: found 'much'" in " ".join(wrong.output.split())
    missing = command("run", "waveform", "--csv", tmp_path / "none.csv")
    assert missing.exit_code == 3
    assert "cannot be read" in missing.output
    assert "FILE" in command("run", "waveform", "--help").output
