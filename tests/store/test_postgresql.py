"""What is special about PostgreSQL: the server, its users, its locks."""

import sys

import numpy as np
import psycopg
import pytest
from sqlalchemy import Connection, event, text
from sqlalchemy.exc import IntegrityError

from bench.store import Store
from bench.store.address import database_of, shown
from bench.store.errors import (
    StoreFileError,
    StoreLockedError,
    StoreReadOnlyError,
    StoreUnreachableError,
)
from bench.store.tables.samples import BLOCK_ROWS
from tests.databases import PostgresqlServer, postgresql_server
from tests.store.examples import begin, begin_trial


@pytest.fixture
def backend() -> str:
    return "postgresql"


def test_a_lock_of_another_program_is_waited_for_and_then_named(store_url: str) -> None:
    other = database_of(store_url, 5.0)
    with Store.open(store_url, busy_timeout_s=0.2) as store:
        experiment_id = begin(store)
        with other.writing():
            with pytest.raises(StoreLockedError, match=r"locked by another program for more than 0\.2 s; end what"):
                begin_trial(store, experiment_id)
            assert store.experiments() != []  # readers do not mind
        begin_trial(store, experiment_id)
    other.close()


def test_a_transaction_that_reads_sees_one_state(store: Store, store_url: str) -> None:
    database = database_of(store_url, 5.0)
    with database.reading() as connection:
        count = text("SELECT count(*) FROM experiment")
        before = connection.execute(count).scalar()
        begin(store)
        assert connection.execute(count).scalar() == before == 0
    database.close()


def test_a_server_that_is_not_there_is_named_without_the_password() -> None:
    with pytest.raises(StoreUnreachableError, match="check that the server runs") as caught:
        Store.open("postgresql://ada:secret@localhost:1/bench")
    assert "secret" not in str(caught.value)


def test_a_database_that_is_not_there_is_named(server: PostgresqlServer) -> None:
    with pytest.raises(StoreUnreachableError, match='database "nowhere" does not exist'):
        Store.open(server.url("nowhere"))


def test_a_connection_that_broke_is_made_again(store: Store, server: PostgresqlServer, store_url: str) -> None:
    experiment_id = begin(store)
    server.run("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname LIKE 'bench%'")
    assert store.experiment(experiment_id).outcome == "running"
    later = begin(store)  # and with it the claim, which the server had let go
    with Store.open(store_url) as other:
        assert other.experiment(later).outcome == "running"


def test_a_database_that_may_not_be_written_is_named(server: PostgresqlServer, store: Store, store_url: str) -> None:
    name = store_url.split("/")[3].split("?")[0]
    server.run(f"ALTER DATABASE {name} SET default_transaction_read_only = on")
    with Store.open(store_url) as other, pytest.raises(StoreReadOnlyError, match="may not be written"):
        begin(other)


def test_samples_are_not_compressed(store: Store) -> None:
    query = text("SELECT attstorage FROM pg_attribute WHERE attrelid = 'sample_block'::regclass AND attname = 'data'")
    with store._database.reading() as connection:
        assert connection.execute(query).scalar() in (b"e", "e")


def test_what_fails_while_it_is_sent_is_named_and_nothing_of_it_is_kept(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    width = len(store.trial(writer.trial_id).channels)
    with store._database.writing() as connection:
        connection.execute(text("ALTER TABLE sample_block ADD CHECK (rows < 9)"))
    with pytest.raises((IntegrityError, psycopg.errors.CheckViolation)):  # at the next statement, or at the end
        writer.append(np.zeros((9, width)), [(0.0, "begun", "")])
    assert (store.trial(writer.trial_id).rows, store.events(writer.trial_id)) == (0, [])
    writer.append(np.zeros((8, width)))
    assert store.trial(writer.trial_id).rows == 8


def test_the_missing_driver_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(StoreFileError, match=r"pip install 'friction-bench\[postgresql\]'"):
        Store.open("postgresql://localhost/bench")


def test_a_url_without_a_database_is_refused() -> None:
    with pytest.raises(StoreFileError, match="names no database"):
        Store.open("postgresql://localhost")


def test_a_url_is_shown_without_its_password() -> None:
    assert shown("postgresql://ada:secret@host/bench") == "postgresql://ada:***@host/bench"
    assert shown("sqlite:////lab/bench.sqlite") == "sqlite:////lab/bench.sqlite"


def test_settings_in_a_url_hold_for_its_sessions(store_url: str) -> None:
    database = database_of(f"{store_url}&options=-csynchronous_commit%3Dlocal", 5.0)
    with database.reading() as connection:
        shown_as = {
            name: connection.execute(text(f"SHOW {name}")).scalar() for name in ("synchronous_commit", "lock_timeout")
        }
    database.close()
    assert shown_as == {"synchronous_commit": "local", "lock_timeout": "5s"}


def test_a_block_has_left_before_the_next_one_is_made(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    width, unsent = len(store.trial(writer.trial_id).channels), []

    def look(connection: Connection, cursor: psycopg.Cursor, *_: object) -> None:
        if cursor.connection.pgconn.pipeline_status:
            unsent.append(cursor.connection.pgconn.flush())

    event.listen(store._database.backend.engine, "after_cursor_execute", look)
    writer.append(np.random.default_rng(1).normal(size=(4 * BLOCK_ROWS, width)))
    assert len(unsent) > 4
    assert not any(unsent)


def test_an_append_waits_for_the_lock_of_another_program_and_then_names_it(store_url: str) -> None:
    other = database_of(store_url, 5.0)
    with Store.open(store_url, busy_timeout_s=0.2) as store:
        writer = begin_trial(store, begin(store))
        rows = np.zeros((4 * BLOCK_ROWS, len(store.trial(writer.trial_id).channels)))
        with other.writing(), pytest.raises(StoreLockedError, match=r"for more than 0\.2 s; end what"):
            writer.append(rows)
        writer.append(rows)
        assert store.trial(writer.trial_id).rows == len(rows)
    other.close()


def test_rows_that_a_server_lost_are_told_and_nothing_is_written_behind_the_gap() -> None:
    settings = {"synchronous_commit": "off", "wal_writer_delay": "10s", "wal_writer_flush_after": "0"}
    with postgresql_server(settings) as server, Store.open(server.url(server.create())) as store:
        writer = begin_trial(store, begin(store))
        width = len(store.trial(writer.trial_id).channels)
        server.run("CHECKPOINT")
        writer.append(np.zeros((8, width)))
        server.crash()
        assert store.trial(writer.trial_id).rows == 0  # the server had promised less
        with pytest.raises(StoreFileError, match="lost rows that it had confirmed"):
            writer.append(np.ones((8, width)))
        assert store.trial(writer.trial_id).rows == 0
