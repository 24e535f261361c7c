"""Tokens by their digests, the audit log, and the answers to starts that carried an idempotency key."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0003"

MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Add the tables."""
    op.create_table(
        "access_token",
        sa.Column("id", sa.Integer, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("name", "role", "digest")),
        sa.Column("created_utc", MOMENT, nullable=False),
        sa.Column("expires_utc", MOMENT),
        sa.Column("revoked_utc", MOMENT),
        sa.PrimaryKeyConstraint("id", name="pk_access_token"),
        sa.UniqueConstraint("name", name="uq_access_token_name"),
        sa.UniqueConstraint("digest", name="uq_access_token_digest"),
    )
    op.create_table(
        "audit",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("at_utc", MOMENT, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("token", "role", "client", "method", "path")),
        sa.Column("status", sa.Integer, nullable=False),
        sa.Column("detail", sa.Text, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_audit"),
    )
    op.create_index("ix_audit_at_utc", "audit", ["at_utc"])
    op.create_index("ix_audit_token", "audit", ["token"])
    op.create_table(
        "start_key",
        sa.Column("id", sa.Integer, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("key", "token", "body_digest")),
        sa.Column("status", sa.Integer),
        sa.Column("answer", sa.JSON),
        sa.Column("created_utc", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_start_key"),
        sa.UniqueConstraint("token", "key", name="uq_start_key_token_key"),
    )
    op.create_index("ix_start_key_created_utc", "start_key", ["created_utc"])
