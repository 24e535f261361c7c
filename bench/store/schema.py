"""The tables. A change here needs a migration in `migrations/versions`."""

import re
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    DateTime,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    Text,
    TypeDecorator,
    UniqueConstraint,
)


class UnreadableError(ValueError):
    """Raised for what stands in a column and cannot be what it is for."""


class UtcDateTime(TypeDecorator[datetime]):
    """A time with time zone UTC, also where the database keeps none."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """To UTC, before it is written."""
        return None if value is None else value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """Mark as UTC what was read without a zone."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)

    def result_processor(self, dialect: Dialect, coltype: object) -> Callable[[Any], Any] | None:
        """As SQLAlchemy's; where that fails, the error says what is there."""
        plain = super().result_processor(dialect, coltype)

        def read(value: object) -> object:
            try:
                return value if plain is None else plain(value)
            except (ValueError, TypeError) as error:
                raise UnreadableError(f"no date: {str(value)[:40]!r}") from error

        return read


class PlainText(TypeDecorator[str]):
    """Text without NUL characters: PostgreSQL has no place for them, and a file moves between databases."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: str | None, dialect: Dialect) -> str | None:  # noqa: ARG002
        """Refuse a NUL character before it is written."""
        if value is not None and "\0" in value:
            raise ValueError(f"the text {value[:40]!r} has a NUL character in it, which cannot be kept; leave it out")
        return value


class OwnerToken(PlainText):
    """The name of a process that runs something: part of the name of a file, or a number, see the backends' claims."""

    cache_ok = True
    FORM = re.compile(r"|[0-9]{1,10}-[0-9a-f]{12}|pg-[0-7]?[0-9a-f]{1,15}")

    def process_result_value(self, value: str | None, dialect: Dialect) -> str | None:  # noqa: ARG002
        """Refuse what no process is called."""
        if value is not None and (not isinstance(value, str) or not self.FORM.fullmatch(value)):
            raise UnreadableError(f"no name of a process: {str(value)[:40]!r}")
        return value


METADATA = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_name)s",
        "pk": "pk_%(table_name)s",
    }
)


def _parent(table: str, name: str, *, nullable: bool = False, primary_key: bool = False) -> Column[int]:
    key = ForeignKey(f"{table}.id", ondelete="CASCADE")
    return Column(name, Integer, key, nullable=nullable, primary_key=primary_key, autoincrement=False)


EXPERIMENT = Table(
    "experiment",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("kind", PlainText, nullable=False),
    Column("parameters", JSON, nullable=False),
    Column("source", PlainText, nullable=False),  # simulated, real, imported
    Column("operator", PlainText, nullable=False),
    Column("note", PlainText, nullable=False),
    Column("provenance", JSON, nullable=False),
    Column("rig", JSON, nullable=False),
    Column("owner", OwnerToken, nullable=True),  # who runs it, see owner.py
    Column("started_utc", UtcDateTime, nullable=False),
    Column("finished_utc", UtcDateTime, nullable=True),
    Column("outcome", PlainText, nullable=False),
    Column("reason", PlainText, nullable=False),
    Column("results", JSON, nullable=False),
    # out of the provenance, so that they can be asked for; empty where it does not say
    Column("bench", PlainText, nullable=True),
    Column("software_version", PlainText, nullable=True),
    Column("software_commit", PlainText, nullable=True),
    Column("drive", PlainText, nullable=True),
    Column("firmware", PlainText, nullable=True),
    Column("seed", BigInteger, nullable=True),
    Index(None, "outcome"),
    Index(None, "kind"),
)

TRIAL = Table(
    "trial",
    METADATA,
    Column("id", Integer, primary_key=True),
    _parent("experiment", "experiment_id"),
    Column("name", PlainText, nullable=False),
    Column("kind", PlainText, nullable=False),
    Column("channels", JSON, nullable=False),  # names, in the order of the columns of a sample block
    Column("rows", Integer, nullable=False),
    Column("started_utc", UtcDateTime, nullable=False),
    Column("finished_utc", UtcDateTime, nullable=True),
    Column("outcome", PlainText, nullable=False),
    Column("reason", PlainText, nullable=False),
    Column("results", JSON, nullable=False),
    UniqueConstraint("experiment_id", "name"),
    # a page of a list is found in these alone
    Index(None, "kind", "outcome", "experiment_id"),
    Index(None, "outcome", "experiment_id"),
    Index(None, "experiment_id", "outcome", "kind"),
)

# exactly one of number, text and flag is set: it is the condition's type
TRIAL_CONDITION = Table(
    "trial_condition",
    METADATA,
    _parent("trial", "trial_id", primary_key=True),
    Column("key", PlainText, primary_key=True),
    Column("position", Integer, nullable=False),  # conditions keep their order
    Column("number", Float, nullable=True),
    Column("text", PlainText, nullable=True),
    Column("flag", Boolean, nullable=True),
    Index(None, "key", "number", "trial_id"),
    Index(None, "key", "text", "trial_id"),
    Index(None, "key", "flag", "trial_id"),
)

SAMPLE_BLOCK = Table(
    "sample_block",
    METADATA,
    _parent("trial", "trial_id", primary_key=True),
    Column("first_row", Integer, primary_key=True, autoincrement=False),
    Column("rows", Integer, nullable=False),
    Column("data", LargeBinary, nullable=False),  # see tables/samples.py
    Column("crc32", BigInteger, nullable=True),  # of the data; NULL: written by a version without
)

SAMPLE_OVERVIEW = Table(
    "sample_overview",
    METADATA,
    _parent("trial", "trial_id", primary_key=True),
    Column("first_row", Integer, primary_key=True, autoincrement=False),
    Column("rows", Integer, nullable=False),  # of the trial that it stands for
    Column("data", LargeBinary, nullable=False),  # as a block, with two more columns before it: see plotted/overview.py
    Column("crc32", BigInteger, nullable=True),
)

EVENT = Table(
    "event",
    METADATA,
    Column("id", Integer, primary_key=True),
    _parent("trial", "trial_id"),
    Column("time_s", Float, nullable=False),
    Column("name", PlainText, nullable=False),
    Column("detail", PlainText, nullable=False),
    Index(None, "trial_id", "time_s"),
)

STUDY = Table(
    "study",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("name", PlainText, nullable=False),
    Column("definition", JSON, nullable=False),
    Column("created_utc", UtcDateTime, nullable=False),
)

MODEL = Table(
    "model",
    METADATA,
    Column("id", Integer, primary_key=True),
    _parent("study", "study_id"),
    Column("parent_id", Integer, ForeignKey("model.id"), nullable=True),
    Column("effects", JSON, nullable=False),
    Column("result", JSON, nullable=False),
    Column("created_utc", UtcDateTime, nullable=False),
    Index(None, "study_id"),
    Index(None, "parent_id"),
)

# the experiments and trials behind it are named, not referred to: what was found outlives them
CALIBRATION = Table(
    "calibration",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("note", PlainText, nullable=False),
    Column("source", PlainText, nullable=False),  # as that of its experiments
    Column("rig", JSON, nullable=False),
    Column("drive", JSON, nullable=False),
    Column("provenance", JSON, nullable=False),
    Column("experiment_ids", JSON, nullable=False),
    Column("trial_ids", JSON, nullable=False),
    Column("result", JSON, nullable=False),
    Column("created_utc", UtcDateTime, nullable=False),
    Column("chosen_utc", UtcDateTime, nullable=True),  # when it was last named as the one to use
)

# digests only: who reads the store, or a backup of it, learns no token
ACCESS_TOKEN = Table(
    "access_token",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("name", PlainText, nullable=False),
    Column("role", PlainText, nullable=False),
    Column("digest", PlainText, nullable=False),  # SHA-256 of the token, hexadecimal
    Column("created_utc", UtcDateTime, nullable=False),
    Column("expires_utc", UtcDateTime, nullable=True),
    Column("revoked_utc", UtcDateTime, nullable=True),
    UniqueConstraint("name"),  # for ever: the audit log names tokens by it
    UniqueConstraint("digest"),
)

AUDIT = Table(
    "audit",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("at_utc", UtcDateTime, nullable=False),
    Column("token", PlainText, nullable=False),  # its name; empty where none was accepted
    Column("role", PlainText, nullable=False),
    Column("client", PlainText, nullable=False),  # address
    Column("method", PlainText, nullable=False),
    Column("path", PlainText, nullable=False),
    Column("status", Integer, nullable=False),
    Column("detail", PlainText, nullable=False),  # what was changed
    Index(None, "at_utc"),
    Index(None, "token"),
)

# see tables/chain.py
CHAIN = Table(
    "chain",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=False),  # without gaps
    Column("at_utc", UtcDateTime, nullable=False),
    Column("subject", PlainText, nullable=False),
    Column("row_id", Integer, nullable=False),
    Column("state", PlainText, nullable=False),
    Column("digest", PlainText, nullable=False),
    Column("link", PlainText, nullable=False),
)

# answers to starts that carried an Idempotency-Key
START_KEY = Table(
    "start_key",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("key", PlainText, nullable=False),
    Column("token", PlainText, nullable=False),  # name of the token that sent it
    Column("body_digest", PlainText, nullable=False),
    Column("status", Integer, nullable=True),  # empty while the start is under way
    Column("answer", JSON, nullable=True),
    Column("created_utc", UtcDateTime, nullable=False),
    UniqueConstraint("token", "key"),
    Index(None, "created_utc"),
)

CAMPAIGN = Table(
    "campaign",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("name", PlainText, nullable=False),
    Column("definition", JSON, nullable=False),
    Column("operator", PlainText, nullable=False),
    Column("note", PlainText, nullable=False),
    Column("tags", JSON, nullable=False),
    Column("created_utc", UtcDateTime, nullable=False),
)

# its experiment is named, not referred to: the queue remembers what it ran, also where that was removed
QUEUE_ITEM = Table(
    "queue_item",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("bench", PlainText, nullable=False),
    _parent("campaign", "campaign_id", nullable=True),
    Column("place", Integer, nullable=False),  # order within the bench
    Column("kind", PlainText, nullable=False),
    Column("parameters", JSON, nullable=False),
    Column("operator", PlainText, nullable=False),
    Column("note", PlainText, nullable=False),
    Column("tags", JSON, nullable=False),
    Column("pace", PlainText, nullable=True),
    Column("duration_s", Float, nullable=False),
    Column("loads", JSON, nullable=False),
    Column("state", PlainText, nullable=False),  # waiting, running, or the outcome of its experiment
    Column("reason", PlainText, nullable=False),
    Column("experiment_id", Integer, nullable=True),
    Column("created_utc", UtcDateTime, nullable=False),
    Column("finished_utc", UtcDateTime, nullable=True),
    Column("lab_claim", PlainText, nullable=True),  # of an item that was taken from the laboratory's queue
    Column("owner", OwnerToken, nullable=True),  # who runs it, as of an experiment
    Index(None, "bench", "state", "place"),
    Index(None, "campaign_id"),
)

QUEUE_STATE = Table(
    "queue_state",
    METADATA,
    Column("bench", PlainText, primary_key=True),
    Column("held", Boolean, nullable=False),
    Column("reason", PlainText, nullable=False),
    Column("changed_utc", UtcDateTime, nullable=False),
)

EXPERIMENT_TAG = Table(
    "experiment_tag",
    METADATA,
    _parent("experiment", "experiment_id", primary_key=True),
    Column("tag", PlainText, primary_key=True),
    Index(None, "tag", "experiment_id"),
)

# what benches handed in: by bench, its number there and its start; kept when the experiment is removed
HANDED_IN = Table(
    "handed_in",
    METADATA,
    Column("bench", PlainText, primary_key=True),
    Column("origin_id", Integer, primary_key=True, autoincrement=False),
    Column("started_utc", UtcDateTime, primary_key=True),
    Column("experiment_id", Integer, nullable=False),
    Column("complete", Boolean, nullable=False),
)

# as each bench last told of itself
BENCH = Table(
    "bench",
    METADATA,
    Column("name", PlainText, primary_key=True),
    Column("host", PlainText, nullable=False),
    Column("state", PlainText, nullable=False),
    Column("doing", PlainText, nullable=False),
    Column("lease", PlainText, nullable=False),
    Column("queue", PlainText, nullable=False),
    Column("waiting", Integer, nullable=False),  # experiments that are to be handed in
    Column("seen_utc", UtcDateTime, nullable=False),  # by the clock of the database
)

# see tables/lab_queue.py
LAB_ITEM = Table(
    "lab_item",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("kind", PlainText, nullable=False),
    Column("parameters", JSON, nullable=False),
    Column("operator", PlainText, nullable=False),
    Column("note", PlainText, nullable=False),
    Column("tags", JSON, nullable=False),
    Column("pace", PlainText, nullable=True),
    Column("asked_by", PlainText, nullable=False),  # who asked for it
    Column("for_bench", PlainText, nullable=False),  # empty: any
    Column("for_rig", PlainText, nullable=False),
    Column("for_tags", JSON, nullable=False),
    Column("state", PlainText, nullable=False),  # waiting, taken, running, or the outcome of its experiment
    Column("reason", PlainText, nullable=False),
    Column("bench", PlainText, nullable=False),  # that has it, or had it
    Column("claim", PlainText, nullable=False),  # what the bench was given that has it
    Column("declined", JSON, nullable=False),  # by bench: why it does not take it
    Column("origin_id", Integer, nullable=True),  # its experiment, in the store of its bench
    Column("created_utc", UtcDateTime, nullable=False),
    Column("renewed_utc", UtcDateTime, nullable=True),  # when its bench last said that it has it, by this clock
    Column("finished_utc", UtcDateTime, nullable=True),
    Index(None, "state"),
)
