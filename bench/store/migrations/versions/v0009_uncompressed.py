"""PostgreSQL keeps samples as they come. It tries to compress them otherwise, which takes longer than to write them."""

from alembic import op

revision = "0009"
down_revision = "0008"
TABLES = ("sample_block", "sample_overview")


def upgrade() -> None:
    """What is there already stays as it is; SQLite compresses nothing."""
    if op.get_bind().dialect.name == "postgresql":
        for table in TABLES:
            op.execute(f"ALTER TABLE {table} ALTER COLUMN data SET STORAGE EXTERNAL")
