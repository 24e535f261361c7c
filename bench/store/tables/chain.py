"""The hash chain over the records: what was kept, changed or removed, in the order in which it happened.

Each entry has the SHA-256 of what a record was then, and a link: the SHA-256 of the link before it and of the entry's
own fields. Whoever alters, removes or reorders a record, or an entry, breaks a digest or a link. The newest link, noted
elsewhere, holds all that came before (Haber, Stornetta: How to time-stamp a digital document, 1991).

Each function works inside the caller's transaction; writers take turns, so no two entries follow the same one.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from types import MappingProxyType
from typing import Any

from sqlalchemy import Connection, Select, Table, insert, select

from bench.store.schema import (
    ACCESS_TOKEN,
    AUDIT,
    CALIBRATION,
    CHAIN,
    EVENT,
    EXPERIMENT,
    EXPERIMENT_TAG,
    MODEL,
    SAMPLE_BLOCK,
    STUDY,
    TRIAL,
    TRIAL_CONDITION,
)

KEPT, REMOVED, OLDER = "kept", "removed", "older"  # older: records up to this number were there before the chain
FIRST = "0" * 64  # the link before the first entry
FETCHED = 16


@dataclass(frozen=True, slots=True)
class Subject:
    """A kind of record.

    Attributes:
        parts: tables whose rows belong to it, each with the column that names it and those that order them.
    """

    table: Table
    parts: tuple[tuple[Table, str, tuple[str, ...]], ...] = ()


SUBJECTS: Mapping[str, Subject] = {
    "experiment": Subject(EXPERIMENT, ((EXPERIMENT_TAG, "experiment_id", ("tag",)),)),
    "trial": Subject(
        TRIAL,
        (
            (TRIAL_CONDITION, "trial_id", ("key",)),
            (EVENT, "trial_id", ("id",)),
            (SAMPLE_BLOCK, "trial_id", ("first_row",)),
        ),
    ),
    "study": Subject(STUDY),
    "model": Subject(MODEL),
    "calibration": Subject(CALIBRATION),
    "access_token": Subject(ACCESS_TOKEN),
    "audit": Subject(AUDIT),
}


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of the chain.

    Attributes:
        id: its place, counted from 1 without gaps.
        subject: one of `SUBJECTS`.
        row_id: of the record; of audit entries that were removed, the last of them.
        state: `KEPT`, `REMOVED` or `OLDER`.
        digest: of the record, hexadecimal; "" where it was removed.
        link: hexadecimal.
    """

    id: int
    at_utc: datetime
    subject: str
    row_id: int
    state: str
    digest: str
    link: str


def link_of(before: str, entry: Mapping[str, Any]) -> str:
    """The link of an entry that follows another one.

    Args:
        before: the link of the other; `FIRST` for the first.
        entry: the fields of `Entry` other than `link`.
    """
    fields = (before, entry["id"], _plain(entry["at_utc"]), entry["subject"], entry["row_id"], entry["state"])
    return sha256("\n".join(map(str, (*fields, entry["digest"]))).encode()).hexdigest()


def seal(connection: Connection, subject: str, row_ids: Iterable[int]) -> None:
    """Enter records as they are now: they were just kept or changed."""
    digests = ((row_id, digest_of(connection, subject, row_id)) for row_id in row_ids)
    enter(connection, subject, {row_id: digest for row_id, digest in digests if digest is not None})


def enter(connection: Connection, subject: str, digests: Mapping[int, str]) -> None:
    """Enter records whose digests are known: `digest_of` was asked before this transaction, which is short then."""
    _append(connection, subject, KEPT, digests)


def seal_removal(connection: Connection, subject: str, row_ids: Iterable[int]) -> None:
    """Enter that records are removed, in an orderly way."""
    _append(connection, subject, REMOVED, dict.fromkeys(row_ids, ""))


def head(connection: Connection) -> tuple[int, str]:
    """Number and link of the newest entry; 0 and `FIRST` of an empty chain."""
    newest = connection.execute(select(CHAIN.c.id, CHAIN.c.link).order_by(CHAIN.c.id.desc()).limit(1)).one_or_none()
    return (0, FIRST) if newest is None else (newest.id, newest.link)


def entries(connection: Connection) -> Iterator[Entry]:
    """All of them, in their order."""
    found = connection.execute(select(CHAIN).order_by(CHAIN.c.id), execution_options={"yield_per": 1000})
    yield from (Entry(**row._asdict()) for row in found)


def digest_of(
    connection: Connection, subject: str, row_id: int, changes: Mapping[str, object] = MappingProxyType({})
) -> str | None:
    """SHA-256 of a record with all that belongs to it, hexadecimal; None where it is not there.

    Args:
        connection: inside a transaction.
        subject: one of `SUBJECTS`.
        row_id: of the record.
        changes: columns of its row that will have these values once it is entered.
    """
    of = SUBJECTS[subject]
    row = connection.execute(select(of.table).where(of.table.c.id == row_id)).one_or_none()
    if row is None:
        return None
    found = sha256(_text(row._asdict() | dict(changes)))
    for part, key, order in of.parts:
        query = select(part).where(part.c[key] == row_id).order_by(*(part.c[name] for name in order))
        _take(connection, query, found.update)
    return found.hexdigest()


def _take(connection: Connection, query: Select[Any], update: Callable[[bytes], object]) -> None:
    for row in connection.execute(query, execution_options={"yield_per": FETCHED}):
        update(_text(row._asdict()))


def _append(connection: Connection, subject: str, state: str, digests: Mapping[int, str]) -> None:
    if not digests:
        return
    last, before = head(connection)
    common = {"at_utc": datetime.now(UTC), "subject": subject, "state": state}
    made: list[dict[str, object]] = []
    for place, (row_id, digest) in enumerate(digests.items(), last + 1):
        entry = {**common, "id": place, "row_id": row_id, "digest": digest}
        before = link_of(before, entry)
        made.append({**entry, "link": before})
    connection.execute(insert(CHAIN), made)


def _text(row: Mapping[str, object]) -> bytes:
    """A row as text that is the same in every database."""
    values = {name: _plain(value) for name, value in row.items()}
    return json.dumps(values, sort_keys=True, separators=(",", ":"), default=str).encode() + b"\n"


def _plain(value: object) -> object:
    if isinstance(value, datetime):
        return value.astimezone(UTC).isoformat(timespec="microseconds")
    if isinstance(value, bytes | memoryview):
        return sha256(value).hexdigest()
    return value
