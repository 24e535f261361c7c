"""PostgreSQL: all that is special about it, for a laboratory with several benches.

Writers take turns by one advisory lock, as SQLite makes them: the same code sees the same order of
things on both. A transaction that reads sees one state throughout (repeatable read). A process that
runs experiments holds an advisory lock of its own in a session of its own: the server lets go of it
when the process, or its network, is gone.
"""

import secrets
import selectors
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any, cast

from sqlalchemy import Connection, create_engine, event, text
from sqlalchemy.engine import URL
from sqlalchemy.exc import DBAPIError

from bench.store.errors import (
    StoreError,
    StoreFileError,
    StoreFullError,
    StoreLockedError,
    StoreReadOnlyError,
    StoreUnreachableError,
    StoreValueError,
)
from bench.store.tables.json_text import from_json, to_json

WRITER_KEY = 0x46524943  # "FRIC": below all keys of claims
CLAIM_PREFIX = "pg-"
CONNECT_TIMEOUT_S = 10
LOST = "23502"  # NULL where none may be: samples do not continue what the trial has, see tables/samples.py
# a link that is cut is noticed in seconds, not in the quarter of an hour that TCP goes on for
LINK = {"keepalives_idle": 5, "keepalives_interval": 2, "keepalives_count": 3, "tcp_user_timeout": 10_000}


class Postgresql:
    """See `Backend`.

    Args:
        url: "postgresql://user@host/database".
        busy_timeout_s: how long a writer waits for another one [s].

    Raises:
        StoreFileError: the driver is not installed, or the URL names no database.
    """

    def __init__(self, url: URL, busy_timeout_s: float) -> None:
        self._driver = _driver()
        self.where = url.render_as_string(hide_password=True)
        if not url.database:
            raise StoreFileError(f"store '{self.where}' names no database; write postgresql://user@host/database")
        self.write_options: Mapping[str, str | bool] = {"isolation_level": "READ COMMITTED"}
        self._busy_timeout_s = busy_timeout_s
        self.engine = create_engine(
            url.set(drivername="postgresql+psycopg"),
            isolation_level="REPEATABLE READ",
            connect_args={
                "options": _options(url, busy_timeout_s),
                "connect_timeout": CONNECT_TIMEOUT_S,
                **LINK,
            },
            pool_pre_ping=True,  # the server may have been restarted
            max_overflow=-1,
            json_serializer=to_json,
            json_deserializer=from_json,
        )
        event.listen(self.engine, "after_cursor_execute", _send_all)

    @property
    def is_read_only(self) -> bool:
        """The server says so where it is, at the first statement that writes."""
        return False

    def begin_read(self) -> None:
        """The server knows whether its database is there."""

    def begin_write(self, connection: Connection) -> None:
        """Wait for other writers."""
        connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": WRITER_KEY})

    def make_durable(self, connection: Connection) -> None:
        """On disk when it is committed, also where the server is told to promise less."""
        query = (
            "SELECT set_config('synchronous_commit', 'on', true) WHERE current_setting('synchronous_commit') = 'off'"
        )
        connection.execute(text(query))

    @contextmanager
    def sending(self, connection: Connection) -> Iterator[None]:
        """By libpq's pipeline: one round trip for all of it. The commit, which is waited for, stays outside."""
        try:
            with cast(Any, connection.connection.driver_connection).pipeline():
                yield
        except self._driver.Error as error:  # raised by the pipeline's end, where SQLAlchemy does not see it
            raise self.explain(error) or error from error

    def explain(self, error: BaseException | None) -> StoreError | None:
        """By the class of the error, and by its SQLSTATE (PostgreSQL manual, appendix A)."""
        if not isinstance(error, self._driver.Error):
            return None
        state = getattr(error, "sqlstate", None) or ""
        where, told = f"store '{self.where}'", str(error).strip()
        if state in ("55P03", "40P01"):
            return StoreLockedError(
                f"{where} is locked by another program for more than {self._busy_timeout_s:g} s; "
                "end what holds it (an import, a backup, an open console), then try again"
            )
        if state == "53100":
            return StoreFullError(f"{where}: the server's disk is full; free some space there. Earlier blocks are kept")
        if state == LOST:
            return StoreFileError(
                f"{where} lost rows that it had confirmed ({told}): its server was killed while synchronous_commit was "
                "off; repeat the trial"
            )
        if state in ("25006", "42501"):
            return StoreReadOnlyError(f"{where} may not be written ({told}); give the user rights on the database")
        if state.startswith("22") or isinstance(error, self._driver.DataError):
            return StoreValueError(f"{where}: {told}")
        if state.startswith("XX"):
            return StoreFileError(f"{where} is damaged ({told}); look at the server's log, and restore a backup")
        if state[:2] in ("", "08", "57", "53", "28", "3D") and isinstance(error, self._driver.OperationalError):
            return StoreUnreachableError(
                f"{where} cannot be reached ({told}); check that the server runs, and name, user and password"
            )
        return None

    def size_bytes(self) -> int:
        """Of the database on the server."""
        with self.engine.connect() as connection:
            return int(connection.execute(text("SELECT pg_database_size(current_database())")).scalar_one())

    def free_bytes(self) -> None:
        """The server does not tell."""

    def check(self) -> list[str]:
        """Nothing: a server checks what it reads (initdb --data-checksums), and says so in its log."""
        return []

    def vacuum(self) -> None:
        """As the server's own autovacuum does from time to time."""
        with self.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text("VACUUM (ANALYZE)"))

    def claim(self) -> "SessionClaim":
        """A session that holds a lock of its own."""
        return SessionClaim(self.engine.connect())

    def lives(self, token: str | None) -> bool:
        """Whether the lock of a claim is taken."""
        if token is None or not token.startswith(CLAIM_PREFIX):
            return False
        with self.engine.connect() as connection, connection.begin():
            query = text("SELECT pg_try_advisory_xact_lock(:key)")
            return not connection.execute(query, {"key": int(token.removeprefix(CLAIM_PREFIX), 16)}).scalar_one()

    def last_words(self, token: str | None) -> dict[int, tuple[str, str]]:  # noqa: ARG002
        """None are kept."""
        return {}

    def forget(self, token: str | None) -> None:
        """Nothing is left."""


class SessionClaim:
    """A session with the server that holds an advisory lock."""

    def __init__(self, connection: Connection) -> None:
        key = secrets.randbits(62) | 2**40
        self.token = f"{CLAIM_PREFIX}{key:x}"
        try:
            self._connection = connection.execution_options(isolation_level="AUTOCOMMIT")
            self._connection.execute(text("SELECT pg_advisory_lock(:key)"), {"key": key})
        except DBAPIError:
            connection.close()
            raise

    def holds(self) -> bool:
        """Whether the session is still there."""
        try:
            self._connection.execute(text("SELECT 1"))
        except DBAPIError:
            return False
        return True

    def note(self, ends: Mapping[int, tuple[str, str]]) -> None:
        """Nothing is kept beside a server: an end that it does not take is known to this process alone."""

    def release(self, keep_note: bool = False) -> None:  # noqa: ARG002
        """End the session, and with it the lock."""
        self._connection.invalidate()  # not back to the pool: the session would live on
        self._connection.close()


def _send_all(connection: Connection, cursor: Any, *_: object) -> None:  # noqa: ARG001
    """Have the server begin with a statement of a pipeline while the next block is made.

    A block is larger than the buffer of a socket. libpq would keep the rest of it until the next statement.
    """
    link = cursor.connection.pgconn
    if not link.pipeline_status or not link.flush():
        return
    with selectors.DefaultSelector() as waiting:  # any number of a socket, as `select` does not take
        waiting.register(link.socket, selectors.EVENT_READ | selectors.EVENT_WRITE)
        while link.flush():  # it takes in what the server answers, too
            waiting.select()


def _options(url: URL, busy_timeout_s: float) -> str:
    """Settings of a session: the store's, and behind them those of the URL, which would be lost otherwise."""
    own = f"-c lock_timeout={max(1, round(1000 * busy_timeout_s))}"
    return " ".join([own, *url.normalized_query.get("options", ())])


def _driver() -> ModuleType:
    try:
        import psycopg
    except ImportError as error:
        raise StoreFileError(
            "store: PostgreSQL needs the driver psycopg; install it with: pip install 'friction-bench[postgresql]'"
        ) from error
    return psycopg
