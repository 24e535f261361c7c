"""Do the records bear out the hash chain: which were altered, which are gone, which nobody entered."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from typing import Any

from sqlalchemy import Connection, Select, select

from bench.store.records import HIDDEN
from bench.store.schema import EXPERIMENT, TRIAL
from bench.store.tables.chain import FIRST, OLDER, REMOVED, SUBJECTS, Entry, digest_of, entries, link_of

ENDED = {"experiment": EXPERIMENT, "trial": TRIAL}  # entered when they end: one that runs has no entry


@dataclass
class _Known:
    """What the chain says of the records of one kind.

    Attributes:
        newest: number -> the newest entry of a record.
        older: records up to this number were there before the chain.
        removed: records up to this number were removed together.
    """

    newest: dict[int, Entry] = field(default_factory=dict)
    older: int = 0
    removed: int = 0


def broken_chain(connection: Connection, noted: str | None = None) -> list[str]:
    """What is wrong with the chain and the records, in words; nothing is an empty list.

    Args:
        connection: inside a transaction that reads.
        noted: a link that was noted elsewhere; the chain has to hold it. None: there is none.
    """
    known = {subject: _Known() for subject in SUBJECTS}
    problems = list(_broken_links(connection, known, noted))
    for subject, of in known.items():
        problems += _broken_records(connection, subject, of)
    return problems


def _broken_links(connection: Connection, known: dict[str, _Known], noted: str | None) -> Iterator[str]:
    last, before, seen = 0, FIRST, noted is None
    for entry in entries(connection):
        if entry.id != last + 1:
            missing = _numbers("entry", "entries", last + 1, entry.id - 1)
            yield f"chain: {missing} gone: removed past the store"
        elif entry.link != link_of(before, asdict(entry)):
            of = f"{entry.subject} {entry.row_id}"
            yield f"chain: entry {entry.id} ({of}) is not what was written, or stood elsewhere"
        last, before, seen = entry.id, entry.link, seen or entry.link == noted
        _learn(known, entry)
    if not seen:
        yield f"chain: the link {noted} is not in it; its end was cut off, or it was written anew"


def _learn(known: dict[str, _Known], entry: Entry) -> None:
    of = known.get(entry.subject)
    if of is None:  # an altered entry, which is told already
        return
    if entry.state == OLDER:
        of.older = entry.row_id
    elif entry.state == REMOVED and entry.subject == "audit":
        of.removed = max(of.removed, entry.row_id)
    else:
        of.newest[entry.row_id] = entry


def _broken_records(connection: Connection, subject: str, of: _Known) -> Iterator[str]:
    there = set(connection.execute(ended(subject)).scalars())
    for row_id in sorted(there | of.newest.keys()):
        entry = of.newest.get(row_id)
        problem = _problem(connection, subject, row_id, entry, row_id in there, of)
        if problem:
            yield f"{subject.replace('_', ' ')} {row_id} {problem}"


def ended(subject: str) -> Select[Any]:
    """The numbers of the records of a kind that have an entry in the chain."""
    table = SUBJECTS[subject].table
    query = select(table.c.id).order_by(table.c.id)
    return query.where(table.c.outcome.not_in(("running", *HIDDEN))) if subject in ENDED else query


def _problem(
    connection: Connection, subject: str, row_id: int, entry: Entry | None, is_there: bool, of: _Known
) -> str | None:
    if entry is None:
        return None if row_id <= of.older else "was put in past the store: it is not in the chain"
    if entry.state == REMOVED:
        return "was removed, and is there again" if is_there else None
    if not is_there:
        return None if row_id <= of.removed else f"is gone: removed past the store after {_moment(entry)}"
    try:
        digest = digest_of(connection, subject, row_id)
    except (ValueError, TypeError) as error:
        return f"cannot be read any more ({error}); it was sound at {_moment(entry)}"
    return None if digest == entry.digest else f"is not what was kept: altered past the store after {_moment(entry)}"


def _numbers(one: str, more: str, first: int, last: int) -> str:
    return f"{one} {first} is" if first == last else f"{more} {first} .. {last} are"


def _moment(entry: Entry) -> str:
    return f"{entry.at_utc:%Y-%m-%d %H:%M:%S} UTC"
