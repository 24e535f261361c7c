"""`friction-bench import --guess` and `explain` on files that nobody described."""

import json
import re
import shlex
from math import sin

import numpy as np
import pytest

from bench.recording_set import read_mapping, read_recording_set, read_rig
from tests.recording_set.foreign_files import COLUMNS, FILES, POSITION_RAD, TIME_S, VELOCITY_RAD_S, motor_side, rows


def test_a_guess_is_shown_written_and_can_be_imported(command, tmp_path):
    (tmp_path / "log.csv").write_bytes(FILES["german excel, windows-1252"].data)
    guessed = command("import", "--guess", "log.csv")
    assert guessed.exit_code == 0, guessed.output
    for words in ("Winkel [°]", "position_rad", "deg", "decimal comma", "Windows-1252", "then: friction-bench import"):
        assert words in guessed.stdout
    assert json.loads(command("experiments", "--json").stdout) == []  # nothing is imported by a guess
    made = command("import", "log.csv", "--mapping", "mapping.toml", "--rig", "rig.toml", "--json")
    assert json.loads(made.stdout)["rows"] == 400


@pytest.mark.parametrize(
    ("words", "taken", "said"),
    [
        ([], "rig.toml", "rig.toml: is there already; use it, --rig rig.toml, or remove it"),
        ([], "mapping.toml", "mapping.toml: is there already; name another file with --mapping, or remove it"),
        (["--mapping", "rig.toml"], "", "the rig is written there; name another file with --mapping"),
    ],
)
def test_where_one_file_cannot_be_written_none_is(command, tmp_path, words, taken, said):
    (tmp_path / "log.csv").write_bytes(FILES["plain"].data)
    if taken:
        (tmp_path / taken).write_text("mine")
    before = {path.name for path in tmp_path.iterdir()}
    guessed = command("import", "--guess", "log.csv", *words)
    assert guessed.exit_code == 3
    assert said in " ".join(guessed.stderr.split())
    assert {path.name for path in tmp_path.iterdir()} == before


def test_load_and_rig_are_told_by_what_a_guess_left_as_comments(command, tmp_path):
    data = FILES["german excel, utf-8 mark"].data
    for name in ("log1.csv", "log2.csv"):
        (tmp_path / name).write_bytes(data)
    guessed = command("import", "--guess", "log1.csv", "log2.csv")
    assert guessed.exit_code == 0, guessed.output
    assert "log2.csv: columns between ';'" in guessed.stdout
    assert "/log2.csv" not in guessed.stdout
    assert f'name = "{tmp_path.name}"' in (tmp_path / "rig.toml").read_text()
    for name, remark in {
        "mapping.toml": "all files are listed then.\n",
        "rig.toml": "its unit, and what it is.\n",
    }.items():
        head, found, keys = (tmp_path / name).read_text().partition(remark)
        assert found
        (tmp_path / name).write_text(head + found + re.sub("^# ", "", keys, flags=re.MULTILINE))
    made = command("import", "log1.csv", "log2.csv", "--mapping", "mapping.toml", "--rig", "rig.toml", "--json")
    assert made.exit_code == 0, made.output
    trials = json.loads(command("trials", "--json").stdout)
    assert [trial["conditions"] for trial in trials] == 2 * [{"load_kg": 0.1, "arm_m": 0.5}]
    assert read_rig(tmp_path / "rig.toml").gear.ratio == 20


def test_a_mapping_that_lies_in_the_folder_is_used_and_named_and_one_beside_it_is_told_of(command, tmp_path):
    folder = tmp_path / "logs"
    folder.mkdir()
    random, time_s = np.random.default_rng(5), np.arange(0.0, 8.0, 0.01)
    amps = 0.2 * np.tanh(20.0 * np.cos(3.0 * time_s)) + 0.01 * random.standard_normal(len(time_s))
    rows = np.column_stack([time_s, 60.0 * np.sin(3.0 * time_s), amps])
    np.savetxt(folder / "log1.csv", rows, "%.5f", ",", header="t,angle,amps", comments="")
    answer = ["--take", "angle=position[deg]", "--take", "amps=current[A]"]
    guessed = command("import", "--guess", "logs", *answer)
    assert guessed.exit_code == 0, guessed.output
    assert {path.name for path in folder.iterdir()} == {"log1.csv", "mapping.toml", "rig.toml"}
    for words in (["import", "logs"], ["explain", "logs", "--html", "logs.html"]):
        read = command(*words)
        assert read.exit_code == 0, read.output
        assert "logs/mapping.toml: the mapping that was used" in read.stdout
    asked = command("explain", "logs", *answer)
    assert asked.exit_code == 3, "it is not passed over"
    assert "mapping.toml: tells what each column is" in asked.stderr
    for place in (folder, tmp_path):
        (folder / "mapping.toml").replace(place / "mapping.toml")
        asked = command("explain", "logs/log1.csv", "--json")
        assert asked.exit_code == 3
        named = (place / "mapping.toml").relative_to(tmp_path)
        assert f"{named} is not used; where it is of these files, add: --mapping {named}" in asked.stderr
        (place / "mapping.toml").replace(folder / "mapping.toml")


def test_repeats_that_do_not_move_alike_are_warned_of(command, tmp_path):
    for name, position in (("one", POSITION_RAD), ("two", POSITION_RAD), ("other", VELOCITY_RAD_S[::-1])):
        (tmp_path / f"{name}.csv").write_text(rows({**COLUMNS, "position_rad": position}))
    (tmp_path / "rig.toml").write_text('name = "arm"\n')
    for names, warned in ((["one.csv", "two.csv"], False), (["one.csv", "two.csv", "other.csv"], True)):
        told = [f'[[trials]]\nfile = "{name}"\nconditions = {{ repeat = 1 }}\n' for name in names]
        (tmp_path / "repeats.toml").write_text("".join(told))
        made = command("import", *names, "--mapping", "repeats.toml", "--rig", "rig.toml")
        assert made.exit_code == 0, made.output
        said = " ".join(made.stdout.split())
        assert ("are told as repeats of each other, and their motions differ" in said) == warned
    guessed = command("import", "--guess", "one.csv", "--mapping", "new.toml", "--rig", "rig.toml")
    assert guessed.exit_code == 0, guessed.output
    for condition in ("waveform", "repeat", "session_s"):
        assert f"#   {condition} = " in (tmp_path / "new.toml").read_text()


def test_files_whose_columns_differ_are_guessed_one_by_one(command, tmp_path):
    (tmp_path / "log1.csv").write_bytes(FILES["german excel, utf-8 mark"].data)
    (tmp_path / "log2.csv").write_bytes(FILES["plain"].data.replace(b"time_s", b"clock"))
    result = command("import", "--guess", "log1.csv", "log2.csv")
    assert result.exit_code == 3
    assert "log2.csv has other columns" in result.stderr.replace("\n", " ")
    assert "guessed one by one" in result.stderr.replace("\n", " ")
    assert not (tmp_path / "mapping.toml").exists()


@pytest.mark.parametrize(("ratio", "words"), [(50.0, []), (60.3, ["--rig", "mine.toml"])])
def test_a_speed_of_the_motor_is_told_and_its_mapping_can_be_imported(command, tmp_path, ratio, words):
    (tmp_path / "log.csv").write_bytes(motor_side(ratio))
    (tmp_path / "mine.toml").write_text(f'name = "arm"\n[gear]\nratio = {ratio}\n')
    guessed = command("import", "--guess", "log.csv", *words)
    assert guessed.exit_code == 0, guessed.output
    assert f"that speed is of the motor side, behind a gear of about {ratio:g}" in " ".join(guessed.stdout.split())
    assert read_mapping(tmp_path / "mapping.toml").columns["velocity_rad_s"].scale == 1.0 / ratio
    assert command("import", "log.csv", "--mapping", "mapping.toml", "--rig", "mine.toml").exit_code == 0
    assert command("export", 1, "set").exit_code == 0
    (recording,) = read_recording_set(tmp_path / "set").recordings
    np.testing.assert_allclose(recording.channels["velocity_rad_s"], VELOCITY_RAD_S, atol=1e-4)


def test_what_is_not_sure_is_asked_and_nothing_is_written(command, tmp_path):
    (tmp_path / "log.csv").write_bytes(FILES["duty of 50"].data)
    result = command("import", "--guess", "log.csv")
    assert result.exit_code == 3
    assert "--take 'duty=duty[%]'" in result.stderr
    assert not (tmp_path / "mapping.toml").exists()
    answered = command("import", "--guess", "log.csv", "--take", "duty=duty[%]")
    assert answered.exit_code == 0, answered.output
    assert 'unit = "%"' in (tmp_path / "mapping.toml").read_text()


@pytest.mark.parametrize("take", ["duty", "duty=warp", "duty=duty[parsec]", "nothing=current[A]"])
def test_an_answer_that_is_none_is_explained(command, tmp_path, take):
    (tmp_path / "log.csv").write_bytes(FILES["duty of 50"].data)
    result = command("import", "--guess", "log.csv", "--take", take)
    assert result.exit_code == 3
    assert "--take" in result.stderr


def test_the_command_that_a_guess_ends_with_imports_what_it_guessed(command, tmp_path):
    names = [f"log {number} of a long afternoon at the bench.csv" for number in range(8)]
    for name in names:
        (tmp_path / name).write_bytes(FILES["german excel, utf-8 mark"].data)
    guessed = command("--store", "other.sqlite", "import", "--guess", *names)
    [line] = [line for line in guessed.stdout.splitlines() if line.startswith("then: friction-bench ")]
    made = command(*shlex.split(line.removeprefix("then: friction-bench ")), "--json")
    assert made.exit_code == 0, made.output
    assert json.loads(made.stdout)["trials"] == len(names)


def test_the_same_recordings_are_told_when_they_come_in_again(command, tmp_path):
    (tmp_path / "log.csv").write_bytes(FILES["degrees and rpm"].data)
    assert command("import", "--guess", "log.csv").exit_code == 0
    words = ["import", "log.csv", "--mapping", "mapping.toml", "--rig", "rig.toml"]
    first = command(*words)
    assert first.stderr == ""
    assert "imported as experiment 1: 1 trial, 400 rows" in first.stdout
    mapping = tmp_path / "mapping.toml"
    mapping.write_text(mapping.read_text().replace('unit = "rpm"', 'unit = "rpm"\nscale = 1.01'))
    assert "experiment 1 has the same recordings already" in command(*words, "--json").stderr
    for factor in (1.0, 1.1):  # another recording under the same name, as long as the first
        measured = {"position_rad": factor * POSITION_RAD, "current_a": TIME_S + factor}
        (tmp_path / "else.csv").write_text(rows({**COLUMNS, **measured}))
        assert command("import", "else.csv", "--rig", "rig.toml").stderr == ""
    assert len(json.loads(command("experiments", "--json").stdout)) == 4


def test_a_report_is_not_written_over(command, tmp_path):
    (tmp_path / "log.csv").write_bytes(FILES["plain"].data)
    (tmp_path / "mine.html").write_text("mine")
    result = command("explain", "log.csv", "--html", "mine.html")
    assert result.exit_code == 3
    assert "mine.html" in result.stderr
    assert json.loads(command("experiments", "--json").stdout) == []


def test_a_file_that_must_be_asked_about_is_not_explained(command, tmp_path):
    (tmp_path / "log.csv").write_bytes(FILES["counts, not told"].data)
    result = command("explain", "log.csv")
    assert result.exit_code == 3
    assert "--counts-per-turn" in result.stderr
    assert json.loads(command("experiments", "--json").stdout) == []


def test_which_effects_were_not_judged_is_said_beside_the_report(command, tmp_path):
    random, files = np.random.default_rng(3), []
    time_s = np.arange(0.0, 12.0, 0.005)
    for sign in (1.0, -1.0):
        for repeat in (1, 2):
            speed = sign * 150.0 * (1.0 - np.exp(-time_s / 3.0))
            torque = 1e-4 * np.gradient(speed, time_s) + 1e-4 * speed + 0.01 * sign
            torque += 1e-4 * random.standard_normal(len(time_s))
            files.append(tmp_path / f"turn{sign:+.0f}-{repeat}.csv")
            rows = np.column_stack([time_s, np.cumsum(speed) * 0.005, torque])
            np.savetxt(files[-1], rows, "%.7f", ",", header="time_s,position_rad,torque_n_m", comments="")
    (tmp_path / "rig.toml").write_text('name = "free shaft"\nhorizontal = true\n')
    result = command("explain", *files, "--rig", "rig.toml", "--name", "shaft", "--html", "shaft.html")
    assert result.exit_code == 0, result.output
    sections = (tmp_path / "shaft.html").read_text().split("<h2")
    count = next(one.count("Not judged: ") for one in reversed(sections) if "Not judged: " in one)  # of the last model
    assert count > 0
    told = re.search(
        rf"{count} effects were not judged, the report says why: ([a-z_, ]+)\.", " ".join(result.stdout.split())
    )
    assert told, result.stdout
    assert len(told[1].split(", ")) == count


def test_loads_that_nobody_told_are_asked_for(command, tmp_path):
    random, files = np.random.default_rng(4), []
    time_s = np.arange(0.0, 12.0, 0.005)
    for number, moment_n_m in enumerate((0.3, 0.3, 0.5, 0.5)):
        position = (1.2 + 0.1 * number) * np.sin(2.0 * np.pi * (0.2 + 0.03 * number) * time_s)
        speed = np.gradient(position, time_s)
        torque = 0.01 * np.gradient(speed, time_s) + moment_n_m * np.sin(position) + 0.05 * np.tanh(speed / 0.02)
        torque += 2e-3 * random.standard_normal(len(time_s))
        files.append(tmp_path / f"swing{number}.csv")
        rows = np.column_stack([time_s, position, torque])
        np.savetxt(files[-1], rows, "%.7f", ",", header="time_s,position_rad,torque_n_m", comments="")
    result = command("explain", *files, "--name", "arm", "--html", "arm.html")
    assert result.exit_code == 0, result.output
    said = " ".join(result.stdout.split())
    assert "The weight that the joint carries differs from run to run" in said
    assert "Were other loads hung? Tell load_kg of each trial." in said


def test_a_joint_that_never_slid_is_reported_and_not_refused(command, tmp_path):
    time_s = [0.01 * index for index in range(1200)]
    rows = [f"{t:.2f},{0.3 + 0.002 * sin(t):.7f},{0.3 * sin(t):.6f}" for t in time_s]
    (tmp_path / "push.csv").write_text("\n".join(["time_s,position_rad,torque_n_m", *rows]))
    result = command("explain", "push.csv")
    assert result.exit_code == 0, result.output
    assert "springs back, with 150 N m/rad" in result.stdout
    assert "breakaway lies beyond that" in result.stdout
    assert "Effort over position" in (tmp_path / "explain-push.html").read_text()
    again = command("explain", "push.csv")
    assert again.exit_code == 0, again.output
    assert "written: explain-push-2.html" in again.stdout
    assert "experiment 1 has the same recordings already" in again.stderr
    assert (tmp_path / "explain-push-2.html").exists()
    assert json.loads(command("study", "list", "--json").stdout) == []


def test_what_an_export_wrote_is_explained_as_it_is(command, tmp_path):
    """Few rows of a trial have an event, which is no number; nothing of a recording set is guessed."""
    motions = ["--waveforms", "slow-sine,multisine", "--loads-kg", "0.05", "--duration-s", 4]
    assert command("run", "excitation", *motions, "--json").exit_code == 0
    assert command("export", 1, "set").exit_code == 0
    file = next(path for path in (tmp_path / "set").glob("slow-sine*.csv"))
    assert ",event\n" in file.read_text()
    assert "taken for" in command("import", "--guess", file).stdout
    for number, words in enumerate((["set"], [file, "--rig", "set/rig.toml"]), start=1):
        result = command("--store", "other.sqlite", "explain", *words, "--html", f"{number}.html")
        assert result.exit_code == 0, result.output
        assert "taken for" not in result.stdout
        assert (tmp_path / f"{number}.html").exists()
