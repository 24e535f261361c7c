"""Databases of every released schema, with data in them, become those of this version."""

import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import MetaData, create_engine, insert, select
from sqlalchemy.pool import StaticPool

from bench.store import Event, Store
from bench.store.address import database_of
from bench.store.database import Database
from bench.store.migration import HEAD, MIGRATIONS, NEW_FILE, _upgrade
from tests.store.freeze import PROVENANCE, RELEASED, rows
from tests.store.new_file import text_of_new_file

FILES = sorted(RELEASED.glob("*.sql"))


def load(url: str, file: Path) -> None:
    """Make a database as the released version left it."""
    text = file.read_text(encoding="utf-8")
    if url.startswith("sqlite"):
        with closing(sqlite3.connect(url.removeprefix("sqlite:///"))) as connection:
            connection.executescript(text)
        return
    database = database_of(url, 1.0)
    with database.writing() as connection:
        _upgrade(connection, url, None, file.stem)
    copy_rows(text, database)
    database.close()


def copy_rows(text: str, database: Database) -> None:
    """The rows of an SQLite dump into the same tables of another database."""
    memory = create_engine("sqlite://", poolclass=StaticPool)
    raw = memory.raw_connection()
    raw.driver_connection.executescript(text)  # type: ignore[union-attr]
    source, target = MetaData(), MetaData()
    source.reflect(memory)
    target.reflect(database.backend.engine)
    with memory.connect() as read, database.writing() as write:
        for table in target.sorted_tables:
            found = [dict(row._mapping) for row in read.execute(select(source.tables[table.name]))]
            for row in found:
                row.update({key: value.replace(tzinfo=UTC) for key, value in row.items() if type(value) is datetime})
            if found and table.name != "alembic_version":
                write.execute(insert(table), found)
    raw.close()
    memory.dispose()


def test_every_schema_before_this_one_is_tested() -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.set_main_option("path_separator", "os")
    scripts = ScriptDirectory.from_config(config)
    assert scripts.get_heads() == [HEAD]
    assert {file.stem for file in FILES} == {script.revision for script in scripts.walk_revisions()} - {HEAD}


def test_what_is_kept_of_the_migrations_is_what_they_make() -> None:
    assert NEW_FILE.read_text(encoding="utf-8") == text_of_new_file(), "python -m tests.store.new_file writes it"


def test_a_new_file_is_what_the_migrations_make(tmp_path: Path) -> None:
    database = database_of(f"sqlite:///{tmp_path}/migrated.sqlite", 1.0)
    with database.writing() as connection:
        _upgrade(connection, database.where, None)
    database.close()
    for name in ("first", "second"):
        Store.open(f"sqlite:///{tmp_path}/{name}.sqlite").close()
    migrated, first, second = (dump(tmp_path / f"{name}.sqlite") for name in ("migrated", "first", "second"))
    assert first == second == migrated


def dump(path: Path) -> list[str]:
    """All statements that would make a file anew."""
    with closing(sqlite3.connect(path)) as connection:
        return list(connection.iterdump())


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_what_was_kept_is_there_after_the_upgrade(url: str, file: Path) -> None:
    load(url, file)
    with Store.open(url) as store:
        steps, running = store.experiment(1), store.experiment(2)
        assert (steps.kind, steps.operator, steps.note, steps.outcome) == ("steps", "Ada", "grüße", "completed")
        assert (steps.parameters, steps.provenance, steps.results) == ({"repeats": 2}, PROVENANCE, {"spread_a": None})
        assert steps.started_utc.tzinfo is UTC
        assert (running.outcome, store.trial(3).outcome) == ("interrupted", "interrupted")
        assert store.trial(2).conditions == {"load_kg": 0.1, "balanced": False, "grease": "NLGI 2", "repeat": 2.0}
        assert (store.trial(1).rows, store.trial(3).rows) == (120, 5)
        samples = store.samples(1)
        assert np.array_equal(samples["time_s"], rows(0, 120)[:, 0])
        assert np.allclose(samples["position_rad"], rows(0, 120)[:, 1], rtol=0, atol=1e-15)
        assert np.isnan(samples["duty"]).all()
        assert store.events(1) == [Event(0.5, "breakaway", "up")]
        assert store.study(1).definition == {"trial_ids": [1], "held_out": [False]}
        assert [(model.parent_id, model.result) for model in store.models(1)] == [
            (None, {"error": 0.25}),
            (1, {"error": 0.125}),
        ]
        assert len(store.samples_reduced(1, None, 10)["time_s"]) < 120


@pytest.mark.parametrize("file", FILES[:1], ids=lambda file: file.stem)
def test_the_facts_of_the_provenance_become_columns(url: str, file: Path) -> None:
    load(url, file)
    Store.open(url).close()
    database = database_of(url, 1.0)
    query = "SELECT bench, software_version, software_commit, drive, firmware, seed FROM experiment ORDER BY id"
    with database.reading() as connection:
        found = [tuple(row) for row in connection.exec_driver_sql(query)]
    database.close()
    assert found == [("bench 3", "0.1.0", "f00d", "simulated drive", "1.2", 7), (None,) * 6]
