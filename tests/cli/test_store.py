"""`friction-bench store`: what a user types."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.store import Store
from tests.store.freeze import fill


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "bench.sqlite"
    with Store.open(f"sqlite:///{path}") as store:
        fill(store)
    return path


def run(path: Path, *words: str, config: Path | None = None) -> "tuple[int, str]":
    options = ["--store", str(path), *(["--config", str(config)] if config else [])]
    done = CliRunner().invoke(app, [*options, "store", *words])
    return done.exit_code, done.output


def test_info_check_backup_vacuum(path: Path, tmp_path: Path) -> None:
    code, text = run(path, "info", "--json")
    assert code == 0
    assert json.loads(text)["rows"] == 245
    assert run(path, "check") == (0, "the store is sound\n")
    code, text = run(path, "backup", str(tmp_path / "copy.sqlite"))
    assert (code, Path(tmp_path / "copy.sqlite").exists()) == (0, True), text
    assert run(tmp_path / "copy.sqlite", "check")[0] == 0
    code, text = run(path, "vacuum")
    assert code == 0
    assert text.endswith("smaller\n")


def test_prune_lists_first_and_removes_only_when_told(path: Path, tmp_path: Path) -> None:
    from bench.config.configuration import PRESETS

    assert "everything is kept" in run(path, "prune")[1]
    config = tmp_path / "bench.toml"
    config.write_text((PRESETS / "paper.toml").read_text() + "\n[store.retention]\nincomplete_days = 1e-9\n")
    code, text = run(path, "prune", config=config)
    assert code == 0
    assert "1 of 1 to remove with --delete" in text
    with Store.open(f"sqlite:///{path}") as store:
        assert len(store.experiments()) == 2
    assert "1 of 1 removed" in run(path, "prune", "--delete", config=config)[1]
    with Store.open(f"sqlite:///{path}") as store:
        assert [one.kind for one in store.experiments()] == ["steps"]


def test_what_a_study_uses_goes_only_when_that_is_said(path: Path, tmp_path: Path) -> None:
    from bench.config.configuration import PRESETS

    config = tmp_path / "bench.toml"
    config.write_text((PRESETS / "paper.toml").read_text() + "\n[store.retention]\ncompleted_days = 1e-9\n")
    text = run(path, "prune", "--delete", config=config)[1]
    assert "study 1 (gear 12)" in text
    assert "0 of 1 removed" in text
    assert "1 of 1 removed" in run(path, "prune", "--delete", "--used-too", config=config)[1]


def test_a_damaged_store_has_an_exit_code(path: Path) -> None:
    with Store.open(f"sqlite:///{path}") as store, store._database.writing() as connection:
        connection.exec_driver_sql("DELETE FROM sample_block WHERE trial_id = 2 AND first_row = 0")
    code, text = run(path, "check")
    assert code == 1
    assert "trial 2 has 120 rows" in text


def test_remove_by_number_with_a_reason_that_is_kept(path: Path) -> None:
    assert run(path, "remove", "experiment", "1")[0] == 2  # no reason
    code, text = run(path, "remove", "experiment", "1", "--reason", " ")
    assert (code, "the reason is empty" in text) == (2, True)
    code, text = run(path, "remove", "experiment", "1", "--reason", "wrong arm")
    assert (code, "study 1" in text) == (3, True), text
    assert run(path, "remove", "study", "1", "--reason", "a draft")[0] == 0
    code, text = run(path, "remove", "experiment", "1", "--reason", "wrong arm")
    assert (code, "experiment 1 (" in text) == (0, True), text
    with Store.open(f"sqlite:///{path}") as store:
        assert [one.id for one in store.experiments()] == [2]
        newest = store.access.audit.find()[0]
    assert newest.path == "store remove experiment 1"
    assert newest.detail.startswith("removed experiment 1 (")
    assert "wrong arm, by user" in newest.detail
