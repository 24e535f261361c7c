"""Which process runs an item of a bench's queue."""

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"


def upgrade() -> None:
    """Add the column."""
    op.add_column("queue_item", sa.Column("owner", sa.Text))
