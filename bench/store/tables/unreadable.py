"""Where in a store something stands that cannot be read: a row that this software did not write."""

from sqlalchemy import JSON, Column, Connection, Engine, select
from sqlalchemy.exc import SQLAlchemyError

from bench.store.schema import METADATA, OwnerToken, UnreadableError, UtcDateTime


def place_of_unreadable(engine: Engine) -> str:
    """Table, row and column of the first of them, in words that follow the name of the store; "" where none is found.

    All tables are read for it: a column says that it cannot read a value, but does not know whose it is.
    """
    suspects = [
        column
        for table in METADATA.sorted_tables
        for column in table.columns
        if isinstance(column.type, JSON | UtcDateTime | OwnerToken)
    ]
    try:
        with engine.connect() as connection:
            rows = ((column, _unreadable_row(connection, column)) for column in suspects)
            return next((f", table {one.table}, row {row}: its {one.name}" for one, row in rows if row is not None), "")
    except SQLAlchemyError:
        return ""  # it has not these tables, or is damaged more than that


def _unreadable_row(connection: Connection, column: Column[object]) -> str | None:
    """The key of the first row whose value cannot be read."""
    key = list(column.table.primary_key)
    sound = 0
    with connection.execute(select(column).order_by(*key), execution_options={"yield_per": 1}) as found:
        try:
            for _ in found:
                sound += 1
        except UnreadableError:
            row = connection.execute(select(*key).order_by(*key).offset(sound).limit(1)).one()
            return ", ".join(map(str, row))
    return None
