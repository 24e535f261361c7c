"""`friction-bench commission`: what it refuses before anything is asked or moves."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import typer
from typer.testing import CliRunner

from bench.cli.app import app
from bench.cli.operation.commission import _Terminal
from bench.commission.bench_file import write_bench
from bench.commission.evidence import Evidence
from bench.commission.questions import FIRST_LOAD, HAND_ANGLE, LOAD, CommissionError
from bench.commission.simulated_hand import SimulatedHand
from bench.config.configuration import default_configuration, read_configuration
from compensator.line_fit import Interval


def _run(folder: Path, *words: str):
    store = ["--store", str(folder / "trials.sqlite")]
    return CliRunner().invoke(app, [*store, "commission", "--out", str(folder / "bench.toml"), *words])


def test_a_bench_that_is_there_is_not_overwritten(tmp_path):
    (tmp_path / "bench.toml").write_text("name = 'mine'\n")
    ran = _run(tmp_path, "--port", "nowhere")
    assert ran.exit_code == 3
    assert "is there already" in " ".join(ran.output.split())
    assert (tmp_path / "bench.toml").read_text() == "name = 'mine'\n"


def test_one_place_of_the_drive_is_wanted(tmp_path):
    assert _run(tmp_path).exit_code == 2
    assert _run(tmp_path, "--port", "a", "--bus", "b:c").exit_code == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [("[drive]\nport = 'x'\n", "holds no section [drive]"), ("[drive]\nkind = 'sim'\n", "drives on a wire")],
)
def test_a_section_that_reaches_no_drive_is_refused(tmp_path, text, said):
    (tmp_path / "drive.toml").write_text(text)
    ran = _run(tmp_path, "--drive", str(tmp_path / "drive.toml"))
    assert ran.exit_code == 3
    assert said in " ".join(ran.output.split())
    assert not (tmp_path / "bench.toml").exists()


def test_what_is_written_reads_back_the_same_with_its_evidence_beside_it(tmp_path):
    bench, evidence = default_configuration(), Evidence()
    evidence.add_interval("torque at the joint", Interval(1.0, 0.9, 1.1), "N m/A", "a weight")
    write_bench(tmp_path / "bench.toml", bench.model_copy(update={"master": None}), evidence)
    assert read_configuration(tmp_path / "bench.toml") == bench.model_copy(update={"master": None})
    assert '"low": 0.9' in (tmp_path / "bench.evidence.json").read_text()


@pytest.mark.parametrize("question", [HAND_ANGLE, FIRST_LOAD])
def test_an_answer_of_the_file_does_not_stand_for_the_deed(monkeypatch, question):
    """An arm that swings would give sign and scale by itself, and a weight would count that nobody has hung."""
    said, typed = [], iter(["", "q"])
    monkeypatch.setattr(typer, "prompt", lambda sentence, **_: said.append(sentence) or next(typed))
    person = _Terminal({question.key: 40.0, "load_kg": 0.1})
    assert person.number(LOAD) == 0.1
    assert said == []
    assert person.number(question) == 40.0
    assert said == [f"{question.sentence} The answers say 40 {question.unit}. Enter when done, q to give up"]
    with pytest.raises(CommissionError, match="given up at"):
        person.number(question)


def test_what_hands_do_nothing_for_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(typer, "prompt", lambda *_, **__: pytest.fail("nothing is to be done"))
    assert _Terminal({"first_load_kg": 0}).number(FIRST_LOAD) == 0.0
    with pytest.raises(CommissionError, match=r"hand_angle_deg is 5 degrees; allowed is 20 \.\. 180"):
        _Terminal({"hand_angle_deg": 5}).number(HAND_ANGLE)
    hung = []
    joint = SimpleNamespace(hang_load=lambda load_kg, **_: hung.append(load_kg))
    assert SimulatedHand(_Terminal({"first_load_kg": 0.05}), joint).number(FIRST_LOAD) == 0.05
    assert hung == [0.05]
