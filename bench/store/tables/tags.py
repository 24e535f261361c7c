"""Tags of experiments: free words that they are found by. Each function works inside the caller's transaction."""

from collections.abc import Iterable

from sqlalchemy import ColumnElement, Connection, delete, insert, select

from bench.store.errors import StoreValueError
from bench.store.schema import EXPERIMENT, EXPERIMENT_TAG

MOST_TAGS = 50
LONGEST_TAG = 100
ASKED_BY_ID = 500  # more, and all tags are read: a database takes only so many values in one query


def checked(tags: Iterable[str]) -> list[str]:
    """Tags without doubles, in order.

    Raises:
        StoreValueError: one that is empty, has spaces around it or is too long; too many.
    """
    found = sorted(set(tags))
    for tag in found:
        if not tag or tag != tag.strip() or len(tag) > LONGEST_TAG:
            raise StoreValueError(f"tag '{tag[:40]}': wanted 1 .. {LONGEST_TAG} characters, without spaces around them")
    if len(found) > MOST_TAGS:
        raise StoreValueError(f"found {len(found)} tags; wanted at most {MOST_TAGS}")
    return found


def write(connection: Connection, experiment_id: int, tags: Iterable[str]) -> None:
    """Give an experiment these tags instead of those that it had; as `checked`."""
    rows = [{"experiment_id": experiment_id, "tag": tag} for tag in checked(tags)]
    connection.execute(delete(EXPERIMENT_TAG).where(EXPERIMENT_TAG.c.experiment_id == experiment_id))
    if rows:
        connection.execute(insert(EXPERIMENT_TAG), rows)


def of_experiments(connection: Connection, experiment_ids: list[int]) -> dict[int, tuple[str, ...]]:
    """The tags of each, in order; nothing where it has none."""
    table = EXPERIMENT_TAG.c
    query = select(table.experiment_id, table.tag).order_by(table.experiment_id, table.tag)
    if len(experiment_ids) <= ASKED_BY_ID:
        query = query.where(table.experiment_id.in_(experiment_ids))
    found: dict[int, tuple[str, ...]] = {}
    for row in connection.execute(query):
        found[row.experiment_id] = (*found.get(row.experiment_id, ()), row.tag)
    return found


def with_tag(tag: str) -> ColumnElement[bool]:
    """A filter of experiments."""
    table = EXPERIMENT_TAG.c
    return EXPERIMENT.c.id.in_(select(table.experiment_id).where(table.tag == tag))
