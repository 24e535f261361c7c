"""`friction-bench export` and `import`."""

import json

import numpy as np
import pytest

from bench.store import Store

NEGATIVE_RESISTANCE = 'name = "r"\n[motor]\nresistance_ohm = -1\n'


@pytest.mark.parametrize("place", ["set", "set.zip"])
def test_what_leaves_comes_back_the_same(command, tmp_path, place):
    assert command("run", "steps", "--repeats", 1).exit_code == 0
    assert command("export", 1, place).exit_code == 0
    back = json.loads(command("import", place, "--name", "back", "--json").stdout)
    assert (back["experiment_id"], back["trials"]) == (2, 1)
    assert "back" in command("experiments").stdout
    with Store.open(f"sqlite:///{tmp_path / 'friction-bench.sqlite'}") as store:
        [before], [after] = store.trials(1), store.trials(2)
        sent, received = store.samples(before.id), store.samples(after.id)
    assert sent.keys() == received.keys()
    for name, values in sent.items():
        assert np.array_equal(values, received[name], equal_nan=True), name


def test_an_import_with_rig_and_mapping(command, tmp_path):
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "run.csv").write_text("t;angle_deg\n0;0\n0,1;90\n0,2;180\n")
    (tmp_path / "rig.toml").write_text('name = "somebody\'s bench"\n')
    (tmp_path / "mapping.toml").write_text(
        'delimiter = ";"\ndecimal = ","\n[columns.time_s]\nfrom = "t"\n'
        '[columns.position_rad]\nfrom = "angle_deg"\nscale = 0.017453292519943295\n'
    )
    result = command("import", "foreign", "--rig", "rig.toml", "--mapping", "mapping.toml", "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout) == {"experiment_id": 1, "name": "foreign", "trials": 1, "rows": 3}
    assert command("trial", 1, "--csv").stdout.splitlines()[2].startswith("0.1,1.57079632679")


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"a.csv": "time_s,duty\n0,0\n1,x\n", "rig.toml": 'name = "r"'}, ["a.csv", "line 3", "'x'"]),
        ({"a.csv": "time_s,duty\n0,0\n1,0\n"}, ["rig.toml", "is not there"]),
        (
            {"a.csv": "time_s,duty\n0,0\n1,0\n", "rig.toml": 'name = "r"\n[motor]\nresistance_ohm = -1\n'},
            ["rig.toml", "resistance_ohm"],
        ),
    ],
)
def test_a_bad_set_names_file_and_line_and_leaves_nothing(command, tmp_path, files, words):
    (tmp_path / "bad").mkdir()
    for name, text in files.items():
        (tmp_path / "bad" / name).write_text(text)
    result = command("import", "bad")
    assert result.exit_code == 3
    for word in words:
        assert word in result.stderr
    assert json.loads(command("experiments", "--json").stdout) == []


def test_a_missing_rig_or_mapping_file_is_named(command, tmp_path):
    (tmp_path / "a.csv").write_text("time_s,duty\n0,0\n1,0\n")
    assert "no-rig.toml" in command("import", "a.csv", "--rig", "no-rig.toml").stderr
    assert "no-map.toml" in command("import", "a.csv", "--mapping", "no-map.toml").stderr


def test_nothing_is_overwritten(command, tmp_path):
    assert command("run", "steps", "--repeats", 1).exit_code == 0
    (tmp_path / "taken.zip").write_text("mine")
    result = command("export", 1, "taken.zip")
    assert result.exit_code == 3
    assert "taken.zip" in result.stderr
    assert (tmp_path / "taken.zip").read_text() == "mine"
