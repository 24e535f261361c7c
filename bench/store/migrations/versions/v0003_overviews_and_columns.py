"""Overviews of trials for plots; indexes for lists; the provenance's main facts as columns; views."""

import json
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"

FACTS = {
    "bench": ("configuration", "name"),
    "software_version": ("software", "version"),
    "software_commit": ("software", "commit"),
    "drive": ("drive", "product"),
    "firmware": ("drive", "firmware"),
}
# table -> columns of its indexes before and after
INDEXES = {
    "trial": (
        (("outcome",), ("kind",)),
        (("kind", "outcome", "experiment_id"), ("outcome", "experiment_id"), ("experiment_id", "outcome", "kind")),
    ),
    "trial_condition": (
        (("key", "number"), ("key", "text")),
        (("key", "number", "trial_id"), ("key", "text", "trial_id"), ("key", "flag", "trial_id")),
    ),
}
NUMBERS = ("load_kg", "arm_m", "supply_v", "temperature_c", "speed_rad_s", "repeat")

EXPERIMENT_VIEW = """
CREATE VIEW experiment_view AS
SELECT e.id AS experiment_id, e.kind, e.source, e.operator, e.note, e.bench, e.drive, e.firmware, e.seed,
       e.software_version, e.software_commit, e.started_utc, e.finished_utc, e.outcome, e.reason,
       (SELECT count(*) FROM trial t WHERE t.experiment_id = e.id) AS trials,
       (SELECT coalesce(sum(t.rows), 0) FROM trial t WHERE t.experiment_id = e.id) AS rows
FROM experiment e
WHERE e.outcome NOT IN ('importing', 'removing')
"""
TRIAL_VIEW = """
CREATE VIEW trial_view AS
SELECT t.id AS trial_id, t.experiment_id, t.name, t.kind, t.started_utc, t.finished_utc, t.outcome, t.reason, t.rows,
       {numbers},
       (SELECT c.flag FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'balanced') AS balanced,
       e.source, e.operator, e.bench, e.drive
FROM trial t JOIN experiment e ON e.id = t.experiment_id
WHERE e.outcome NOT IN ('importing', 'removing')
"""
NUMBER = "(SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = '{key}') AS {key}"


def upgrade() -> None:
    """Add columns, table and views; fill the columns of what is there."""
    for name in FACTS:
        op.add_column("experiment", sa.Column(name, sa.Text))
    op.add_column("experiment", sa.Column("seed", sa.BigInteger))
    _fill(op.get_bind())
    op.create_table(
        "sample_overview",
        sa.Column("trial_id", sa.Integer, nullable=False),
        sa.Column("first_row", sa.Integer, nullable=False),
        sa.Column("rows", sa.Integer, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("trial_id", "first_row", name="pk_sample_overview"),
        sa.ForeignKeyConstraint(["trial_id"], ["trial.id"], name="fk_sample_overview_trial_id", ondelete="CASCADE"),
    )
    for table, (before, after) in INDEXES.items():
        _index_instead(table, before, after)
    op.execute(EXPERIMENT_VIEW)
    op.execute(TRIAL_VIEW.format(numbers=",\n       ".join(NUMBER.format(key=key) for key in NUMBERS)))


def _index_instead(table: str, before: tuple[tuple[str, ...], ...], after: tuple[tuple[str, ...], ...]) -> None:
    for columns in before:
        op.drop_index(f"ix_{table}_{'_'.join(columns)}", table)
    for columns in after:
        op.create_index(f"ix_{table}_{'_'.join(columns)}", table, list(columns))


def _fill(connection: sa.Connection) -> None:
    experiment = sa.table("experiment", sa.column("id"), sa.column("provenance", sa.JSON))
    columns = sa.table("experiment", sa.column("id"), sa.column("seed"), *(sa.column(name) for name in FACTS))
    for row in connection.execute(sa.select(experiment)).all():
        known = row.provenance if isinstance(row.provenance, dict) else json.loads(row.provenance or "{}")
        connection.execute(sa.update(columns).where(columns.c.id == row.id).values(**_facts(known)))


def _facts(provenance: dict[str, Any]) -> dict[str, Any]:
    seed = provenance.get("seed")
    found: dict[str, Any] = {"seed": seed if isinstance(seed, int) and abs(seed) < 2**63 else None}
    for name, (section, key) in FACTS.items():
        value = (provenance.get(section) or {}).get(key)
        found[name] = None if value is None else str(value)
    return found
