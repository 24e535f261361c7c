"""The queue of a laboratory, and which of its items one of a bench's own is."""

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"

TIME = sa.DateTime(timezone=True)
WORDS = ("kind", "operator", "note", "asked_by", "for_bench", "for_rig", "state", "reason", "bench", "claim")


def upgrade() -> None:
    """Add table and column."""
    op.create_table(
        "lab_item",
        sa.Column("id", sa.Integer, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in WORDS),
        *(sa.Column(name, sa.JSON, nullable=False) for name in ("parameters", "tags", "for_tags", "declined")),
        sa.Column("pace", sa.Text),
        sa.Column("origin_id", sa.Integer),
        sa.Column("created_utc", TIME, nullable=False),
        sa.Column("renewed_utc", TIME),
        sa.Column("finished_utc", TIME),
        sa.PrimaryKeyConstraint("id", name="pk_lab_item"),
    )
    op.create_index("ix_lab_item_state", "lab_item", ["state"])
    op.add_column("queue_item", sa.Column("lab_claim", sa.Text))
