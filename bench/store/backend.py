"""What a kind of database has to offer: all that differs between SQLite and PostgreSQL stands behind this."""

from collections.abc import Mapping
from contextlib import AbstractContextManager
from typing import Protocol

from sqlalchemy import Connection, Engine

from bench.store.errors import StoreError


class Claim(Protocol):
    """A process's claim that it runs experiments. It ends with the process, however that ends."""

    token: str

    def holds(self) -> bool:
        """Whether others still see it."""

    def note(self, ends: Mapping[int, tuple[str, str]]) -> None:
        """Keep outcome and reason of experiments outside the database, where that is possible."""

    def release(self, keep_note: bool = False) -> None:
        """Let go; what was noted goes too, unless it is to be kept. Safe to call twice."""


class Backend(Protocol):
    """One database.

    Attributes:
        where: how messages name it; without password.
        engine: connections are made as they are needed.
        write_options: execution options of a connection that is going to write.
    """

    where: str
    engine: Engine
    write_options: Mapping[str, str | bool]

    @property
    def is_read_only(self) -> bool:
        """It may be read alone: nobody can write to it from here, and nothing is settled in it."""

    def begin_read(self) -> None:
        """First thing before a transaction that reads: make sure that the database is still there."""

    def begin_write(self, connection: Connection) -> None:
        """First thing in a transaction that writes: wait for other writers, and make sure that it can be kept."""

    def make_durable(self, connection: Connection) -> None:
        """Have this transaction on disk when it is committed, also where others are flushed later."""

    def sending(self, connection: Connection) -> AbstractContextManager[object]:
        """Statements in it may be sent without waiting for the ones before; what fails is raised at its end at last."""

    def explain(self, error: BaseException | None) -> StoreError | None:
        """The store's error for an error of the driver, with the next step; None where it is none of these."""

    def size_bytes(self) -> int:
        """Of the database, with its log."""

    def free_bytes(self) -> int | None:
        """On its disk; None where that is another machine's."""

    def check(self) -> list[str]:
        """What the database itself finds wrong with what it keeps."""

    def vacuum(self) -> None:
        """Give unused space back to the disk. Waits for nobody: nothing may be recorded meanwhile."""

    def claim(self) -> Claim:
        """Say that this process runs experiments. Called inside a transaction that writes."""

    def lives(self, token: str | None) -> bool:
        """Whether the process that made this claim still holds it."""

    def last_words(self, token: str | None) -> dict[int, tuple[str, str]]:
        """Outcome and reason of experiments, as a process noted them before it was gone."""

    def forget(self, token: str | None) -> None:
        """Remove what a dead process left outside the database."""
