"""Bring a database to the tables of this version. Alembic is only loaded when there is something to do."""

from functools import cache
from pathlib import Path

from sqlalchemy import Connection, inspect, text

from bench import __version__
from bench.store.database import Database
from bench.store.errors import StoreFileError, StoreVersionError

HEAD = "0012"  # the newest revision in migrations/versions
MIGRATIONS = Path(__file__).parent / "migrations"
NEW_FILE = MIGRATIONS / "new_file.sql"  # `python -m tests.store.new_file` writes it


def migrate(database: Database) -> None:
    """Create or upgrade the tables, in one transaction. Does nothing where they are up to date.

    Raises:
        StoreVersionError: the database was made by a newer version.
        StoreFileError: the file belongs to another program.
    """
    with database.reading() as connection:
        if _revision(connection) == HEAD:
            return
    with database.writing() as connection:  # another process may have been faster: look again under the lock
        found = _revision(connection)
        if found is None and inspect(connection).get_table_names():
            raise StoreFileError(f"store '{database.where}' belongs to another program; name another")
        if found is None and connection.dialect.name == "sqlite":
            for statement in _of_a_new_file():
                connection.exec_driver_sql(statement)
            connection.execute(text("INSERT INTO alembic_version VALUES (:head)"), {"head": HEAD})
        elif found != HEAD:
            _upgrade(connection, database.where, found)


def _revision(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()


@cache
def _of_a_new_file() -> tuple[str, ...]:
    """What the migrations make of an empty SQLite file: kept, as to run them takes a quarter of a second."""
    return tuple(NEW_FILE.read_text(encoding="utf-8").rstrip("\n").split("\n\n"))


def _upgrade(connection: Connection, where: str, found: str | None, target: str = "head") -> None:
    from alembic import command
    from alembic.config import Config
    from alembic.script import ScriptDirectory

    config = Config(attributes={"connection": connection})
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    if found is not None and found not in known:
        raise StoreVersionError(
            f"store '{where}' was made by a newer version (schema {found}; version {__version__} knows "
            f"up to {HEAD}); install the newer version, or name another"
        )
    command.upgrade(config, target)
