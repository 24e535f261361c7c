"""Benches of a laboratory, and what they handed in."""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"


def upgrade() -> None:
    """Add the tables."""
    op.create_table(
        "handed_in",
        sa.Column("bench", sa.Text, nullable=False),
        sa.Column("origin_id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("started_utc", sa.DateTime(timezone=True), nullable=False),
        sa.Column("experiment_id", sa.Integer, nullable=False),
        sa.Column("complete", sa.Boolean, nullable=False),
        sa.PrimaryKeyConstraint("bench", "origin_id", "started_utc", name="pk_handed_in"),
    )
    op.create_table(
        "bench",
        sa.Column("name", sa.Text, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("host", "state", "doing", "lease", "queue")),
        sa.Column("waiting", sa.Integer, nullable=False),
        sa.Column("seen_utc", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("name", name="pk_bench"),
    )
