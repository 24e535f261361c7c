"""Opening a database: new, old, newer, somebody else's."""

import threading

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import inspect, text

from bench.store import Store
from bench.store.address import database_of
from bench.store.errors import StoreFileError, StoreStateError, StoreVersionError
from bench.store.migration import HEAD, MIGRATIONS
from bench.store.schema import METADATA
from tests.store.examples import begin


def test_the_migrations_make_the_tables_of_the_schema(store_url: str) -> None:
    database = database_of(store_url, 1.0)
    with database.reading() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, METADATA) == []
    database.close()


def test_the_newest_migration_is_the_head() -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.set_main_option("path_separator", "os")
    assert ScriptDirectory.from_config(config).get_current_head() == HEAD


def test_opening_again_keeps_everything(url: str) -> None:
    with Store.open(url) as store:
        study_id = store.create_study("s", {})
    with Store.open(url) as store:
        assert store.study(study_id).name == "s"


def test_several_may_create_it_at_once(url: str) -> None:
    errors: list[BaseException] = []
    barrier = threading.Barrier(4)

    def opens() -> None:
        barrier.wait()
        try:
            Store.open(url).close()
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=opens) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []


def test_a_database_of_a_newer_version_is_left_alone(url: str) -> None:
    Store.open(url).close()
    database = database_of(url, 1.0)
    with database.writing() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    database.close()
    with pytest.raises(StoreVersionError, match=r"newer version \(schema 9999.*install the newer version"):
        Store.open(url)


def test_a_database_of_another_program_is_left_alone(url: str) -> None:
    database = database_of(url, 1.0)
    with database.writing() as connection:
        connection.execute(text("CREATE TABLE bookmarks (address TEXT)"))
    with pytest.raises(StoreFileError, match="belongs to another program; name another"):
        Store.open(url)
    with database.reading() as connection:
        assert inspect(connection).get_table_names() == ["bookmarks"]
    database.close()


def test_a_closed_store_runs_nothing_more(store_url: str) -> None:
    with Store.open(store_url) as store:
        begin(store)
        store.close()
        with pytest.raises(StoreStateError, match="was closed; open it again"):
            begin(store)
    with Store.open(store_url) as again:
        assert [one.outcome for one in again.experiments()] == ["interrupted"]
