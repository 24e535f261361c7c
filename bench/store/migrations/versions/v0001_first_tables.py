"""First tables: experiments, trials, conditions, samples, events, studies, models."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Create all tables."""
    _experiments()
    _trials()
    _samples()
    _studies()


def _experiments() -> None:
    op.create_table(
        "experiment",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("kind", sa.Text, nullable=False),
        sa.Column("parameters", sa.JSON, nullable=False),
        sa.Column("source", sa.Text, nullable=False),
        sa.Column("operator", sa.Text, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("provenance", sa.JSON, nullable=False),
        sa.Column("rig", sa.JSON, nullable=False),
        sa.Column("owner", sa.Text),
        sa.Column("started_utc", TIME, nullable=False),
        sa.Column("finished_utc", TIME),
        sa.Column("outcome", sa.Text, nullable=False),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("results", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_experiment"),
    )
    op.create_index("ix_experiment_outcome", "experiment", ["outcome"])
    op.create_index("ix_experiment_kind", "experiment", ["kind"])


def _trials() -> None:
    op.create_table(
        "trial",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("experiment_id", sa.Integer, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("kind", sa.Text, nullable=False),
        sa.Column("channels", sa.JSON, nullable=False),
        sa.Column("rows", sa.Integer, nullable=False),
        sa.Column("started_utc", TIME, nullable=False),
        sa.Column("finished_utc", TIME),
        sa.Column("outcome", sa.Text, nullable=False),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("results", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_trial"),
        _inside("trial", "experiment"),
        sa.UniqueConstraint("experiment_id", "name", name="uq_trial_experiment_id_name"),
    )
    op.create_index("ix_trial_outcome", "trial", ["outcome"])
    op.create_index("ix_trial_kind", "trial", ["kind"])
    op.create_table(
        "trial_condition",
        sa.Column("trial_id", sa.Integer, nullable=False),
        sa.Column("key", sa.Text, nullable=False),
        sa.Column("position", sa.Integer, nullable=False),
        sa.Column("number", sa.Float),
        sa.Column("text", sa.Text),
        sa.Column("flag", sa.Boolean),
        sa.PrimaryKeyConstraint("trial_id", "key", name="pk_trial_condition"),
        _inside("trial_condition", "trial"),
    )
    op.create_index("ix_trial_condition_key_number", "trial_condition", ["key", "number"])
    op.create_index("ix_trial_condition_key_text", "trial_condition", ["key", "text"])


def _samples() -> None:
    op.create_table(
        "sample_block",
        sa.Column("trial_id", sa.Integer, nullable=False),
        sa.Column("first_row", sa.Integer, nullable=False),
        sa.Column("rows", sa.Integer, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("trial_id", "first_row", name="pk_sample_block"),
        _inside("sample_block", "trial"),
    )
    op.create_table(
        "event",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("trial_id", sa.Integer, nullable=False),
        sa.Column("time_s", sa.Float, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("detail", sa.Text, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_event"),
        _inside("event", "trial"),
    )
    op.create_index("ix_event_trial_id_time_s", "event", ["trial_id", "time_s"])


def _studies() -> None:
    op.create_table(
        "study",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("definition", sa.JSON, nullable=False),
        sa.Column("created_utc", TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_study"),
    )
    op.create_table(
        "model",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("study_id", sa.Integer, nullable=False),
        sa.Column("parent_id", sa.Integer),
        sa.Column("effects", sa.JSON, nullable=False),
        sa.Column("result", sa.JSON, nullable=False),
        sa.Column("created_utc", TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_model"),
        _inside("model", "study"),
        sa.ForeignKeyConstraint(["parent_id"], ["model.id"], name="fk_model_parent_id"),
    )
    op.create_index("ix_model_study_id", "model", ["study_id"])
    op.create_index("ix_model_parent_id", "model", ["parent_id"])


def _inside(table: str, parent: str) -> sa.ForeignKeyConstraint:
    name = f"fk_{table}_{parent}_id"
    return sa.ForeignKeyConstraint([f"{parent}_id"], [f"{parent}.id"], name=name, ondelete="CASCADE")
