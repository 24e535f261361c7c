"""`friction-bench commission`: what it refuses before anything is asked or moves."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.commission.bench_file import write_bench
from bench.commission.evidence import Evidence
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
