"""Checksums of blocks. Those that are there keep none: what they were when they came is not known any more."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
TABLES = ("sample_block", "sample_overview")


def upgrade() -> None:
    """Add the columns."""
    for table in TABLES:
        op.add_column(table, sa.Column("crc32", sa.BigInteger, nullable=True))
