"""Looking after a store: information, check, backup, vacuum, retention, room on the disk."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import text, update

from bench.config.sections import RetentionSettings
from bench.store import Store
from bench.store.errors import StoreFileError, StoreFullError, StoreStateError
from bench.store.schema import EXPERIMENT
from bench.store.tables import chain
from bench.store.tables.samples import damaged_blocks
from bench.store.upkeep.space import SpaceNeed
from tests.databases import PostgresqlServer
from tests.store.examples import begin, begin_trial, rows
from tests.store.freeze import fill


def finished(store: Store, days_ago: float, outcome: str = "completed", source: str = "real") -> int:
    experiment_id = begin(store, source=source)
    begin_trial(store, experiment_id).append(rows(0, 100))
    store.finish_experiment(experiment_id, outcome)
    end = datetime.now(UTC) - timedelta(days=days_ago)
    with store._database.writing() as connection:
        connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(finished_utc=end))
        chain.seal(connection, "experiment", [experiment_id])
    return experiment_id


def test_information_counts_what_is_there(store: Store) -> None:
    fill(store)
    found = store.upkeep.info()
    assert (found.experiments, found.trials, found.rows, found.studies, found.running) == (2, 3, 245, 1, 1)
    assert found.size_bytes > 0
    assert found.oldest_utc is not None


def test_a_sound_store_passes_the_check(store: Store) -> None:
    fill(store)
    assert store.upkeep.check() == []


def test_a_lost_block_is_found(store: Store) -> None:
    fill(store)
    with store._database.writing() as connection:
        connection.execute(text("DELETE FROM sample_block WHERE trial_id = 1 AND first_row = 40"))
    lost, altered = store.upkeep.check()
    assert lost == "trial 1 has 120 rows; its blocks hold 80, in 1920 bytes"
    assert altered.startswith("trial 1 is not what was kept")


def test_a_backup_is_a_store_of_one_moment(store: Store, tmp_path: Path) -> None:
    fill(store)
    store.upkeep.backup(str(tmp_path / "copy.sqlite"))
    store.create_study("later", {})
    assert [path.name for path in tmp_path.iterdir() if "copy" in path.name] == ["copy.sqlite"]
    with Store.open(f"sqlite:///{tmp_path / 'copy.sqlite'}") as copy:
        assert [study.name for study in copy.studies()] == ["gear 12"]
        assert copy.experiment(1) == store.experiment(1)
        assert copy.trial(1) == store.trial(1)
        for name, values in store.samples(1).items():
            assert copy.samples(1)[name].tobytes() == values.tobytes()
        assert copy.upkeep.check() == []


def test_a_backup_overwrites_nothing(store: Store, tmp_path: Path) -> None:
    (tmp_path / "copy.sqlite").write_text("mine")
    with pytest.raises(StoreFileError, match="is there already; name another file"):
        store.upkeep.backup(str(tmp_path / "copy.sqlite"))
    with pytest.raises(StoreFileError, match="does not exist; create it"):
        store.upkeep.backup(str(tmp_path / "nowhere" / "copy.sqlite"))
    assert (tmp_path / "copy.sqlite").read_text() == "mine"


def test_a_store_moves_from_a_file_to_a_server(tmp_path: Path, server: PostgresqlServer) -> None:
    name = server.create()
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as source:
        fill(source)
        source.upkeep.backup(server.url(name))
        with pytest.raises(StoreFileError, match="name an empty database"):
            source.upkeep.backup(server.url(name))
        experiment = source.experiment(1)
    with Store.open(server.url(name)) as copy:
        assert copy.experiment(1) == experiment
        assert begin(copy) == 3  # and it goes on counting
        assert copy.upkeep.check() == []
    server.drop(name)


def test_vacuum_gives_space_back(store: Store) -> None:
    experiment_id = begin(store)
    begin_trial(store, experiment_id).append(np.random.default_rng(1).normal(size=(100_000, 3)))
    with pytest.raises(StoreStateError, match="is being recorded or imported; wait for its end"):
        store.upkeep.vacuum()
    store.finish_experiment(experiment_id, "completed")
    store.retention.remove([experiment_id])
    saved = store.upkeep.vacuum()
    assert saved > 1_000_000
    assert store.experiments() == []


def test_the_policy_keeps_by_outcome_source_and_age(store: Store) -> None:
    old, young = finished(store, 40), finished(store, 1)
    failed = finished(store, 40, outcome="failed")
    simulated = finished(store, 10, source="simulated")
    running = begin(store)
    expired = store.retention.expired

    def found(**policy: float) -> list[int]:
        return [one.experiment_id for one in expired(RetentionSettings(**policy))]

    assert found() == []
    assert found(completed_days=30) == [old]
    assert found(incomplete_days=30) == [failed]
    assert found(simulated_days=5) == [simulated]
    assert found(completed_days=0.5, incomplete_days=0.5) == [old, young, failed, simulated]
    assert running not in found(completed_days=1e-9, incomplete_days=1e-9)
    assert expired(RetentionSettings(completed_days=30))[0].size_bytes == 100 * 3 * 8
    assert len(store.experiments()) == 5  # to look removes nothing


def test_what_a_study_or_a_calibration_uses_is_told(store: Store) -> None:
    studied, calibrated, free = finished(store, 40), finished(store, 40), finished(store, 40)
    (trial,) = store.trials(studied)
    store.create_study("gear 12", {"trial_ids": [trial.id]})
    calibration = {"note": "", "source": "real", "rig": {}, "drive": {}, "provenance": {}, "result": {}}
    store.calibrations.add(**calibration, experiment_ids=[calibrated], trial_ids=[])
    used = {one.experiment_id: one.used_by for one in store.retention.expired(RetentionSettings(completed_days=1))}
    assert used == {studied: ("study 1 (gear 12)",), calibrated: ("calibration 1",), free: ()}


def test_what_is_removed_leaves_no_row(store: Store) -> None:
    gone, kept = finished(store, 40), finished(store, 40)
    store.retention.remove([gone])
    store.retention.remove([gone])  # twice does no harm
    assert [one.id for one in store.experiments()] == [kept]
    assert store.upkeep.check() == []
    with store._database.reading() as connection:
        assert connection.execute(text("SELECT count(*) FROM sample_block")).scalar() == 1


def test_a_trial_that_does_not_fit_on_the_disk_is_refused_with_numbers() -> None:
    need = SpaceNeed.of(trial_s=600.0, period_s=0.001, reserve_mb=200.0, channels=14)
    need.check(10**9, 3, "bench.sqlite")
    need.check(None, 10**6, "a server's disk is not known")
    with pytest.raises(
        StoreFullError, match=r"500 MB are free on its disk; 10 trials \(600 s at 1000 rows/s of 14"
    ) as told:
        need.check(500 * 10**6, 10, "bench.sqlite")
    assert "reserve of 200 MB need 1074 MB" in str(told.value)
    assert "friction-bench store prune" in str(told.value)


def test_every_flipped_bit_of_a_block_is_found_and_its_trial_named(store: Store) -> None:
    fill(store)
    random = np.random.default_rng(5)
    with store._database.writing() as connection:
        blocks = connection.execute(text("SELECT trial_id, first_row, data FROM sample_block")).all()
        for trial, first_row, data in (blocks[index] for index in random.integers(len(blocks), size=1000)):
            damaged = bytearray(data)
            damaged[int(random.integers(len(data)))] ^= 1 << int(random.integers(8))
            change = text("UPDATE sample_block SET data = :data WHERE trial_id = :trial AND first_row = :first")
            at = {"trial": trial, "first": first_row}
            connection.execute(change, {"data": bytes(damaged), **at})
            [(what, named, first, _)] = damaged_blocks(connection)
            assert (what, named, first) == ("samples", trial, first_row)
            connection.execute(change, {"data": data, **at})
        connection.execute(text("UPDATE sample_block SET crc32 = crc32 + 1 WHERE trial_id = 1 AND first_row = 0"))
    damaged, altered = store.upkeep.check()
    assert "trial 1: its samples of rows 0 .." in damaged
    assert altered.startswith("trial 1 is not what was kept")
