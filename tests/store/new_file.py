"""`python -m tests.store.new_file`: keep what all migrations together make of an empty SQLite file."""

from sqlalchemy import create_engine
from sqlalchemy.pool import StaticPool

from bench.store.migration import NEW_FILE, _upgrade


def text_of_new_file() -> str:
    """The statements with an empty line between them."""
    made = _made_by_migrations()
    assert not any("\n\n" in statement for statement in made)
    return "\n\n".join(made) + "\n"


def _made_by_migrations() -> tuple[str, ...]:
    engine = create_engine("sqlite://", poolclass=StaticPool)
    with engine.begin() as connection:
        _upgrade(connection, "memory", None)
        # tables first: some were made anew after an index of another one
        query = "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY type <> 'table', rowid"
        made = tuple(connection.exec_driver_sql(query).scalars())
    engine.dispose()
    return made


if __name__ == "__main__":
    NEW_FILE.write_text(text_of_new_file(), encoding="utf-8")
