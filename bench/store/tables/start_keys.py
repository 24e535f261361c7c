"""Answers to starts that carried an Idempotency-Key: the same key and body again get the same answer."""

from dataclasses import dataclass
from datetime import timedelta

from sqlalchemy import ColumnElement, delete, select, update

from bench.json_types import Json, Values
from bench.store.database import Database
from bench.store.schema import START_KEY
from bench.store.tables.experiments import insert_row, now

KEPT = timedelta(hours=24)


@dataclass(frozen=True, slots=True)
class StartKey:
    """A start that was asked for.

    Attributes:
        body_digest: of what it was asked with.
        status: of the answer; None while there is none yet.
    """

    body_digest: str
    status: int | None
    answer: Json | None


class StartKeys:
    """`Store.access.start_keys`. Every method may be called from any thread."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def claim(self, token: str, key: str, body_digest: str) -> StartKey | None:
        """Note that a start begins; what is there already where the key was used within 24 h, else None."""
        with self._database.writing() as connection:  # one at a time: of two at once, the second finds the first
            connection.execute(delete(START_KEY).where(START_KEY.c.created_utc < now() - KEPT))
            columns = START_KEY.c.body_digest, START_KEY.c.status, START_KEY.c.answer
            found = connection.execute(select(*columns).where(_is(token, key))).one_or_none()
            if found is not None:
                return StartKey(**found._asdict())
            row = {"token": token, "key": key, "body_digest": body_digest, "created_utc": now()}
            insert_row(connection, START_KEY, row)
            return None

    def answer(self, token: str, key: str, status: int, answer: Values) -> None:
        """Keep what was answered."""
        with self._database.writing() as connection:
            connection.execute(update(START_KEY).where(_is(token, key)).values(status=status, answer=answer))

    def forget(self, token: str, key: str) -> None:
        """The start came to nothing that is to be repeated; the key is free again."""
        with self._database.writing() as connection:
            connection.execute(delete(START_KEY).where(_is(token, key)))


def _is(token: str, key: str) -> ColumnElement[bool]:
    return (START_KEY.c.token == token) & (START_KEY.c.key == key)
