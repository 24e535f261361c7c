"""The queue of a bench, campaigns, and tags of experiments."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"

TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Create the tables."""
    op.create_table(
        "campaign",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("definition", sa.JSON, nullable=False),
        sa.Column("operator", sa.Text, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("tags", sa.JSON, nullable=False),
        sa.Column("created_utc", TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_campaign"),
    )
    op.create_table(
        "queue_item",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("bench", sa.Text, nullable=False),
        sa.Column("campaign_id", sa.Integer),
        sa.Column("place", sa.Integer, nullable=False),
        sa.Column("kind", sa.Text, nullable=False),
        sa.Column("parameters", sa.JSON, nullable=False),
        sa.Column("operator", sa.Text, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("tags", sa.JSON, nullable=False),
        sa.Column("pace", sa.Text),
        sa.Column("duration_s", sa.Float, nullable=False),
        sa.Column("loads", sa.JSON, nullable=False),
        sa.Column("state", sa.Text, nullable=False),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("experiment_id", sa.Integer),
        sa.Column("created_utc", TIME, nullable=False),
        sa.Column("finished_utc", TIME),
        sa.PrimaryKeyConstraint("id", name="pk_queue_item"),
        sa.ForeignKeyConstraint(["campaign_id"], ["campaign.id"], name="fk_queue_item_campaign_id", ondelete="CASCADE"),
    )
    op.create_index("ix_queue_item_bench_state_place", "queue_item", ["bench", "state", "place"])
    op.create_index("ix_queue_item_campaign_id", "queue_item", ["campaign_id"])
    op.create_table(
        "queue_state",
        sa.Column("bench", sa.Text, nullable=False),
        sa.Column("held", sa.Boolean, nullable=False),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("changed_utc", TIME, nullable=False),
        sa.PrimaryKeyConstraint("bench", name="pk_queue_state"),
    )
    op.create_table(
        "experiment_tag",
        sa.Column("experiment_id", sa.Integer, nullable=False),
        sa.Column("tag", sa.Text, nullable=False),
        sa.PrimaryKeyConstraint("experiment_id", "tag", name="pk_experiment_tag"),
        sa.ForeignKeyConstraint(
            ["experiment_id"], ["experiment.id"], name="fk_experiment_tag_experiment_id", ondelete="CASCADE"
        ),
    )
    op.create_index("ix_experiment_tag_tag_experiment_id", "experiment_tag", ["tag", "experiment_id"])
