"""Opening a database: new, old, newer, somebody else's."""

import threading
from pathlib import Path

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
from bench.store.upkeep.repair import repair
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


def foreign(url: str, statement: str) -> None:
    """A store of two experiments, the second of which another program has put its hand to."""
    with Store.open(url) as store:
        for _ in range(2):
            store.finish_experiment(begin(store), "completed")
        with store._database.writing() as connection:
            connection.execute(text(f"UPDATE experiment SET {statement} WHERE id = 2"))


def listed(url: str) -> None:
    with Store.open(url) as store:
        store.experiments()


@pytest.mark.parametrize("owner", ["a/b", "../../etc/passwd", "x" * 300, "pg-zz", "pg-ffffffffffffffff"])
def test_an_owner_that_is_no_process_is_named_with_its_row(store_url: str, owner: str) -> None:
    foreign(store_url, f"owner = '{owner}', outcome = 'running'")
    with pytest.raises(StoreFileError, match=r"^store '.+', table experiment, row 2: its owner cannot be read"):
        listed(store_url)


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        ("owner = 'a' || char(0) || 'b', outcome = 'running'", r"its owner cannot be read \(no name of a process"),
        ("parameters = '{bro'", r"its parameters cannot be read \(no JSON: Expecting"),
        (f"rig = '{'[' * 100_000}'", r"its rig cannot be read \(no JSON: maximum recursion"),
        ("started_utc = 'yesterday'", r"its started_utc cannot be read \(no date: 'yesterday'\)"),
        ("finished_utc = 5", r"its finished_utc cannot be read \(no date: '5'\)"),
    ],
)
def test_what_no_column_can_hold_is_named_with_its_row_and_repaired(
    sqlite_url: str, tmp_path: Path, statement: str, named: str
) -> None:
    foreign(sqlite_url, statement)
    with pytest.raises(StoreFileError, match=f"^store '.+', table experiment, row 2: {named}.+store repair$"):
        listed(sqlite_url)
    saved = tmp_path / "saved.sqlite"
    told = repair(sqlite_url, saved)
    assert sum("since a repair" in one for one in told) == 1
    with Store.open(f"sqlite:///{saved}") as store:
        assert store.upkeep.check() == []
        assert len(store.experiments()) == 2
