"""Calibrations: friction curves made from recorded trials, and which of them a bench uses."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"

TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Create the table."""
    op.create_table(
        "calibration",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("source", sa.Text, nullable=False),
        sa.Column("rig", sa.JSON, nullable=False),
        sa.Column("drive", sa.JSON, nullable=False),
        sa.Column("provenance", sa.JSON, nullable=False),
        sa.Column("experiment_ids", sa.JSON, nullable=False),
        sa.Column("trial_ids", sa.JSON, nullable=False),
        sa.Column("result", sa.JSON, nullable=False),
        sa.Column("created_utc", TIME, nullable=False),
        sa.Column("chosen_utc", TIME),
        sa.PrimaryKeyConstraint("id", name="pk_calibration"),
    )
