"""What is exported is read by other programs without options: header, types and numbers."""

import csv
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from bench.config.channels import PAIR_RECORDED, RECORDED
from bench.recording_set import (
    RecordingSetError,
    csv_chunks,
    export_parquet,
    parquet_chunks,
    stream_of_trial,
)
from bench.store import Store, Trial
from compensator.lab.recordings.recording import CHANNELS as CHANNELS_OF_THE_LAB

pandas = pytest.importorskip("pandas", reason="needs pandas: pip install 'friction-bench[test]'")
ROWS = 20_001
CHANNELS = ("time_s", "position_rad", "temperature_c")


@pytest.fixture
def duckdb() -> ModuleType:
    found: ModuleType = pytest.importorskip("duckdb", reason="needs duckdb: pip install 'friction-bench[test]'")
    return found


@pytest.fixture
def backend() -> str:
    return "sqlite"


@pytest.fixture
def experiment_id(store: Store) -> Iterator[int]:
    """Two trials with different channels and conditions, events, and samples that are not there."""
    found = store.begin_experiment("steps", {}, "real", {}, {"name": "paper"})
    generator = np.random.default_rng(5)
    rows = np.column_stack([np.arange(ROWS) / 3.0, generator.normal(size=ROWS), np.full(ROWS, np.nan)])
    rows[-1, 2] = 41.5
    writer = store.begin_trial(found, "a", "step", {"load_kg": 0.1, "balanced": False, "grease": "=2+3"}, CHANNELS)
    writer.append(rows, [(1.0, "=cmd|' /C calc'!A0", "up, slowly")])
    writer.finish("completed")
    other = store.begin_trial(found, "b", "step", {"load_kg": 0.05, "grease": 7.0}, ("time_s", "duty"))
    other.append(np.column_stack([np.arange(5.0), np.full(5, 0.25)]))
    other.finish("stopped", "stop was pressed")
    store.finish_experiment(found, "completed")
    return found


@pytest.fixture
def trial(store: Store, experiment_id: int) -> Trial:
    return store.trials(experiment_id)[0]


@pytest.fixture
def csv_file(store: Store, trial: Trial, tmp_path: Path) -> Path:
    path = tmp_path / "trial.csv"
    path.write_bytes(b"".join(csv_chunks(stream_of_trial(store, trial))))
    return path


@pytest.fixture
def parquet_file(store: Store, experiment_id: int, tmp_path: Path) -> Path:
    path = tmp_path / "experiment.parquet"
    path.write_bytes(b"".join(export_parquet(store, experiment_id)))
    return path


def assert_exact(found: "pandas.DataFrame", store: Store, trial: Trial) -> None:
    for name, values in store.samples(trial.id).items():
        assert found[name].to_numpy(dtype=np.float64, na_value=np.nan).tobytes() == values.tobytes(), name


def test_pandas_reads_the_csv(csv_file: Path, store: Store, trial: Trial) -> None:
    found = pandas.read_csv(csv_file)
    assert list(found.columns) == [*CHANNELS, "event"]
    assert [str(found[name].dtype) for name in CHANNELS] == ["float64"] * 3
    assert_exact(found, store, trial)


def test_duckdb_reads_the_csv(duckdb: ModuleType, csv_file: Path, store: Store, trial: Trial) -> None:
    query = duckdb.sql(f"SELECT * FROM '{csv_file}'")
    assert query.columns == [*CHANNELS, "event"]
    assert query.types[:2] == ["DOUBLE", "DOUBLE"]
    assert_exact(query.df().astype({"temperature_c": "float64"}), store, trial)


def test_matlab_and_excel_take_the_header_and_the_cells_as_they_are(csv_file: Path) -> None:
    """MATLAB renames a column that is no identifier; both want plain text, commas, and a number or nothing."""
    head, *lines = csv_file.read_bytes().decode("ascii").removesuffix("\n").split("\n")
    assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,62}", name) for name in head.split(","))
    for line in lines:
        cells = next(csv.reader([line]))
        assert len(cells) == 1 + head.count(",")
        assert all(re.fullmatch(r"(-?\d+(\.\d+)?(e[-+]?\d+)?)?", cell) for cell in cells[: len(CHANNELS)])


def test_every_channel_that_is_recorded_has_such_a_name() -> None:
    names = {*RECORDED, *PAIR_RECORDED, *CHANNELS_OF_THE_LAB}
    assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,62}", name) for name in names)


def test_no_cell_of_the_csv_is_run_as_a_formula(csv_file: Path) -> None:
    cells = csv_file.read_text().replace('"', "").split("\n")[4].split(",")
    assert cells[3].startswith("'=cmd")


def test_pandas_reads_the_parquet(parquet_file: Path, store: Store, trial: Trial) -> None:
    found = pandas.read_parquet(parquet_file)
    assert len(found) == ROWS + 5
    first = found[found.trial == "a"]
    assert_exact(first, store, trial)
    assert set(first.condition_load_kg.astype(float)) == {0.1}
    assert set(first.condition_balanced.astype(bool)) == {False}
    assert list(first.event.dropna()) == ["'=cmd|' /C calc'!A0: up, slowly"]
    assert first.duty.isna().all()


def test_duckdb_reads_the_parquet(duckdb: ModuleType, parquet_file: Path, experiment_id: int) -> None:
    query = f"""SELECT trial, condition_load_kg, count(*), count(temperature_c), max(duty), any_value(condition_reason)
                FROM '{parquet_file}' GROUP BY ALL ORDER BY trial"""
    assert duckdb.sql(query).fetchall() == [
        ("a", 0.1, ROWS, 1, None, None),
        ("b", 0.05, 5, 0, 0.25, "stop was pressed"),
    ]


def test_a_condition_of_several_types_is_text(duckdb: ModuleType, parquet_file: Path) -> None:
    query = f"SELECT DISTINCT trial, condition_grease FROM '{parquet_file}' ORDER BY trial"
    assert duckdb.sql(query).fetchall() == [("a", "=2+3"), ("b", "7.0")]


def test_one_trial_comes_as_parquet_too(store: Store, trial: Trial, tmp_path: Path) -> None:
    path = tmp_path / "trial.parquet"
    path.write_bytes(b"".join(parquet_chunks([stream_of_trial(store, trial)])))
    assert_exact(pandas.read_parquet(path), store, trial)


def test_the_missing_library_is_named_before_anything_is_sent(
    store: Store, experiment_id: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(RecordingSetError, match=r"pip install 'friction-bench\[parquet\]'"):
        export_parquet(store, experiment_id)


def test_a_trial_that_is_removed_meanwhile_is_named(store: Store, trial: Trial) -> None:
    from bench.store.errors import NotFoundError
    from bench.store.upkeep.retention import remove

    chunks = csv_chunks(stream_of_trial(store, trial))
    next(chunks)
    remove(store._database, trial.experiment_id)
    with pytest.raises(NotFoundError, match="was removed while it was read"):
        list(chunks)
