"""Who did what: one row per request that changed something, or was refused to."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, func, select

from bench.store.database import Database
from bench.store.schema import AUDIT
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row, now


@dataclass(frozen=True, slots=True)
class AuditEntry:
    """One deed.

    Attributes:
        token: name of the token; "" where none was accepted.
        role: of the token; "" likewise.
        client: network address it came from; "" for the command line.
        method, path: of the request, without its query.
    """

    at_utc: datetime
    token: str
    role: str
    client: str
    method: str
    path: str
    status: int
    detail: str


COLUMNS = [AUDIT.c[name] for name in AuditEntry.__dataclass_fields__]


class Audit:
    """`Store.access.audit`. Every method may be called from any thread."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, entries: Sequence[AuditEntry]) -> None:
        """Keep entries, in one transaction."""
        with self._database.writing() as connection:
            for entry in entries:
                chain.seal(connection, "audit", [insert_row(connection, AUDIT, asdict(entry))])

    def find(self, token: str | None = None, limit: int | None = None, offset: int = 0) -> list[AuditEntry]:
        """Newest first; all of them without a limit."""
        query = select(*COLUMNS).order_by(AUDIT.c.id.desc()).limit(limit).offset(offset)
        if token is not None:
            query = query.where(AUDIT.c.token == token)
        with self._database.reading() as connection:
            return [AuditEntry(**row._asdict()) for row in connection.execute(query)]

    def count_older(self, days: float) -> int:
        """How many entries are older than that."""
        with self._database.reading() as connection:
            query = select(func.count()).select_from(AUDIT).where(AUDIT.c.at_utc < now() - timedelta(days=days))
            return int(connection.execute(query).scalar_one())

    def remove_older(self, days: float) -> int:
        """Remove entries older than that. Returns how many."""
        with self._database.writing() as connection:
            older = AUDIT.c.at_utc < now() - timedelta(days=days)
            last = connection.execute(select(func.max(AUDIT.c.id)).where(older)).scalar()
            if last is None:
                return 0
            chain.seal_removal(connection, "audit", [last])
            return connection.execute(delete(AUDIT).where(older)).rowcount
