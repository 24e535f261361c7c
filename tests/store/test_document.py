"""What docs/explanation/store.md says: its SQL runs, its tables and views are there."""

import re
from pathlib import Path

import pytest
from sqlalchemy import inspect, text

from bench.store import Store
from bench.store.schema import METADATA
from tests.store.freeze import fill

DOCUMENT = (Path(__file__).parents[2] / "docs" / "explanation" / "store.md").read_text(encoding="utf-8")
STATEMENTS = re.findall(r"```sql\n(.*?)```", DOCUMENT, re.DOTALL)


def rows(store: Store, statement: str) -> list[dict[str, object]]:
    with store._database.reading() as connection:
        return [dict(row._mapping) for row in connection.execute(text(statement))]


def test_there_are_examples() -> None:
    assert len(STATEMENTS) == 3


def test_the_examples_answer(store: Store) -> None:
    fill(store)
    by_drive, unbalanced, greased = (rows(store, statement) for statement in STATEMENTS)
    assert {"drive": "simulated drive", "outcome": "completed", "rows": 240}.items() <= by_drive[
        [row["outcome"] for row in by_drive].index("completed")
    ].items()
    assert [(row["trial_id"], row["load_kg"], row["repeat"], row["bench"]) for row in unbalanced] == [
        (1, 0.1, 1.0, "bench 3"),
        (2, 0.1, 2.0, "bench 3"),
    ]
    assert [row["grease"] for row in greased] == ["NLGI 2", "NLGI 2"]


@pytest.mark.parametrize("table", [table.name for table in METADATA.sorted_tables])
def test_every_table_is_named(table: str) -> None:
    assert f"`{table}`" in DOCUMENT


def test_the_views_have_the_columns_that_are_named(store: Store) -> None:
    with store._database.reading() as connection:
        found = {
            view: {column["name"] for column in inspect(connection).get_columns(view)}
            for view in ("experiment_view", "trial_view")
        }
    for view, columns in found.items():
        (line,) = (line for line in DOCUMENT.splitlines() if line.startswith(f"- `{view}`"))
        named = {name for group in re.findall(r"`([a-z_, ]+)`", line)[1:] for name in group.split(", ")}
        assert named <= columns


def test_views_hide_what_is_not_there_yet(store: Store) -> None:
    fill(store)
    with store._database.writing() as connection:
        connection.execute(text("UPDATE experiment SET outcome = 'importing' WHERE id = 1"))
    assert [row["experiment_id"] for row in rows(store, "SELECT experiment_id FROM experiment_view")] == [2]
    assert [row["experiment_id"] for row in rows(store, "SELECT experiment_id FROM trial_view")] == [2]
