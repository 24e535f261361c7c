"""The hash chain over the records. What is there already is said to be older than it."""

from datetime import UTC, datetime
from hashlib import sha256

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
SUBJECTS = ("experiment", "trial", "study", "model", "calibration", "access_token", "audit")


def upgrade() -> None:
    """Add the table; note up to which number records are older."""
    chain = op.create_table(
        "chain",
        sa.Column("id", sa.Integer, primary_key=True, autoincrement=False),
        sa.Column("at_utc", sa.DateTime(timezone=True), nullable=False),
        sa.Column("subject", sa.Text, nullable=False),
        sa.Column("row_id", sa.Integer, nullable=False),
        sa.Column("state", sa.Text, nullable=False),
        sa.Column("digest", sa.Text, nullable=False),
        sa.Column("link", sa.Text, nullable=False),
    )
    connection, link, number = op.get_bind(), "0" * 64, 0
    for subject in SUBJECTS:
        last = connection.execute(sa.text(f"SELECT max(id) FROM {subject}")).scalar()  # noqa: S608
        if last is None:
            continue
        number, moment = number + 1, datetime.now(UTC)
        at = moment.isoformat(timespec="microseconds")
        link = sha256("\n".join(map(str, (link, number, at, subject, last, "older", ""))).encode()).hexdigest()
        row = {"id": number, "at_utc": moment, "subject": subject, "row_id": last, "state": "older", "digest": ""}
        connection.execute(sa.insert(chain).values(**row, link=link))
