"""The address of a store: a URL, the database that it names, and how it may be shown."""

from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError

from bench.store.database import Database
from bench.store.errors import StoreFileError

EXAMPLES = "sqlite:///bench.sqlite or postgresql://user@host/database"


def database_of(url: str, busy_timeout_s: float) -> Database:
    """The database that a URL names; nothing is opened yet.

    Args:
        url: "sqlite:///bench.sqlite" (relative), "sqlite:////home/lab/bench.sqlite" (absolute), or
            "postgresql://user@host/database".
        busy_timeout_s: how long a writer waits for another one [s].

    Raises:
        StoreFileError: the URL cannot be read, names no file or folder that is there, or an unknown database.
    """
    parsed = _parsed(url)
    name = parsed.get_backend_name()
    if name == "sqlite":
        from bench.store.sqlite import Sqlite

        return Database(Sqlite(parsed, busy_timeout_s), busy_timeout_s)
    if name == "postgresql":
        from bench.store.postgresql import Postgresql

        return Database(Postgresql(parsed, busy_timeout_s), busy_timeout_s)
    raise StoreFileError(f"store: database '{name}' is not supported; write {EXAMPLES}")


def shown(url: str) -> str:
    """A database URL as it may be shown: without its password."""
    return _parsed(url).render_as_string(hide_password=True)


def _parsed(url: str) -> URL:
    try:
        return make_url(url)
    except ArgumentError as error:
        raise StoreFileError(f"store '{url}' is no database URL; write {EXAMPLES}") from error
