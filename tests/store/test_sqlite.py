"""What is special about SQLite: files, locks, full and read-only disks."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from bench.store import Store
from bench.store.address import database_of
from bench.store.errors import StoreFileError, StoreFullError, StoreLockedError, StoreReadOnlyError
from tests.store.examples import begin, begin_trial, rows
from tests.store.test_interruption import kill, start_writer


@pytest.fixture
def backend() -> str:
    return "sqlite"


def file_of(url: str) -> Path:
    return Path(url.removeprefix("sqlite:///"))


def test_the_database_is_set_up_for_readers_beside_a_writer(store: Store, store_url: str) -> None:
    database = database_of(store_url, 3.0)
    with database.reading() as connection:
        found = {
            name: connection.exec_driver_sql(f"PRAGMA {name}").scalar()
            for name in ("journal_mode", "busy_timeout", "foreign_keys", "synchronous")
        }
    database.close()
    assert found == {"journal_mode": "wal", "busy_timeout": 3000, "foreign_keys": 1, "synchronous": 1}


def test_a_file_that_is_no_database_is_named(url: str) -> None:
    file_of(url).write_text("time_s,position_rad\n" * 100)
    with pytest.raises(StoreFileError, match="is not an SQLite database"):
        Store.open(url)


def test_a_damaged_database_is_named(url: str) -> None:
    with Store.open(url) as store:
        begin_trial(store, begin(store)).append(rows(0, 50_000))
    content = bytearray(file_of(url).read_bytes())
    content[4096:40_000] = bytes(40_000 - 4096)
    file_of(url).write_bytes(content)
    with pytest.raises(StoreFileError, match="damaged"):
        Store.open(url).trials()


def test_only_its_owner_reads_a_new_store(tmp_path: Path) -> None:
    file = tmp_path / "bench.sqlite"
    with Store.open(f"sqlite:///{file}"):
        found = {one.name: one.stat().st_mode & 0o777 for one in tmp_path.iterdir()}
    assert set(found.values()) == {0o600}, found


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("bench.sqlite", "write sqlite:///bench.sqlite"),
        ("sqlite://", "names no file"),
        ("sqlite:///:memory:", "names no file"),
        ("sqlite:////no/such/folder/bench.sqlite", "folder /no/such/folder does not exist"),
        ("mysql://user:secret@host/bench", "'mysql' is not supported"),
    ],
)
def test_a_url_that_names_no_file_is_explained(url: str, message: str) -> None:
    with pytest.raises(StoreFileError, match=message) as caught:
        Store.open(url)
    assert "secret" not in str(caught.value)


def test_a_folder_is_no_database(tmp_path: Path) -> None:
    with pytest.raises(StoreFileError, match="is a folder"):
        Store.open(f"sqlite:///{tmp_path}")


def test_a_lock_of_another_process_is_waited_for_and_then_named(url: str) -> None:
    with Store.open(url, busy_timeout_s=0.2) as store, closing(sqlite3.connect(file_of(url))) as other:
        experiment_id = begin(store)
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(
            StoreLockedError, match=r"locked by another process for more than 0\.2 s; end what holds it \(an import"
        ):
            begin_trial(store, experiment_id)
        assert store.experiments() != []  # readers do not mind
        other.rollback()
        begin_trial(store, experiment_id)


def test_a_full_disk_keeps_what_was_committed(url: str) -> None:
    with Store.open(url) as store:
        writer = begin_trial(store, begin(store))
        writer.append(rows(0, 100))
        with store._database.writing() as connection:
            pages = connection.exec_driver_sql("PRAGMA page_count").scalar()
            connection.exec_driver_sql(f"PRAGMA max_page_count = {pages + 2}")
        with pytest.raises(StoreFullError, match="disk is full; free some space"):
            writer.append(rows(100, 60_000))
        assert store.trial(writer.trial_id).rows == writer.rows == 100
        assert len(store.samples(writer.trial_id)["time_s"]) == 100


def test_a_read_only_database_is_named(store: Store) -> None:
    begin(store)
    with store._database.reading() as connection:
        connection.exec_driver_sql("PRAGMA query_only = ON")
    with pytest.raises(StoreReadOnlyError, match="read-only; make the file and its folder writable"):
        begin(store)
    with store._database.reading() as connection:
        connection.exec_driver_sql("PRAGMA query_only = OFF")


@pytest.mark.parametrize("replaced", [False, True])
def test_nothing_is_written_into_a_database_that_was_taken_away(store: Store, tmp_path: Path, replaced: bool) -> None:
    writer = begin_trial(store, begin(store))
    writer.append(rows(0, 25))
    (tmp_path / "bench.sqlite").rename(tmp_path / "elsewhere.sqlite")
    if replaced:
        (tmp_path / "bench.sqlite").touch()
    for call in (lambda: writer.append(rows(25, 25)), store.experiments, lambda: store.trial(writer.trial_id)):
        with pytest.raises(StoreFileError, match="was deleted, moved or replaced while it was in use"):
            call()
    assert replaced or not (tmp_path / "bench.sqlite").exists()  # nothing has made an empty one


def test_a_kill_leaves_a_sound_file_and_no_lock_behind(url: str) -> None:
    process = start_writer(url)
    assert process.stdout is not None
    process.stdout.readline()
    kill(process)
    with closing(sqlite3.connect(file_of(url))) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    Store.open(url).close()
    assert list(file_of(url).parent.glob("*-owner-*")) == []
