"""Tokens: how they are made and hashed, and those that a user has outside the store.

The store keeps digests alone. SHA-256 without salt or stretching is right for them: a token that is made here is
256 bits from the system's random source, so that neither a dictionary nor a table of digests can hold it, and a
request that carries one has to be answered in microseconds.
"""

import hashlib
import os
import re
import secrets
from dataclasses import dataclass
from enum import StrEnum
from functools import total_ordering
from pathlib import Path

from bench.errors import ConfigurationError
from bench.own_service import checked_token, read_token


@total_ordering
class Role(StrEnum):
    """What a token is good for.

    - viewer: reads, and stops the joint
    - operator: starts and answers experiments, changes studies, calibrations and what is imported
    - admin: takes over the bench, reads the audit log
    """

    VIEWER = "viewer"
    OPERATOR = "operator"
    ADMIN = "admin"

    def __lt__(self, other: str) -> bool:
        order = list(Role)
        return order.index(self) < order.index(Role(other))


@dataclass(frozen=True, slots=True)
class Caller:
    """Whose token came with a request."""

    name: str
    role: Role


TOKEN_VARIABLE = "FRICTION_BENCH_TOKEN"  # noqa: S105  the name of a variable, not a token
ENVIRONMENT, TOKEN_FILE, SAME_USER = "environment", "token-file", "this-user"
RESERVED_NAMES = frozenset({ENVIRONMENT, TOKEN_FILE, SAME_USER, "command-line"})
NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._@-]{0,63}")


def make_token() -> str:
    """A new token: 256 random bits, as 43 characters."""
    return secrets.token_urlsafe(32)


def digest_of(token: str) -> str:
    """What is kept of a token: its SHA-256, hexadecimal."""
    return hashlib.sha256(token.encode(errors="surrogateescape")).hexdigest()


def check_name(name: str) -> None:
    """Refuse a name that a token of the store may not have.

    Raises:
        ConfigurationError: what is wanted.
    """
    if name in RESERVED_NAMES or not NAME_PATTERN.fullmatch(name):
        raise ConfigurationError(
            f"the token's name is '{name}'; wanted are 1 to 64 letters, digits, spaces or ._@-, and none of "
            + ", ".join(sorted(RESERVED_NAMES))
        )


def token_file(store_url: str) -> Path:
    """The file of a token that its owner put there: next to an SQLite store, else in the working directory.

    Args:
        store_url: SQLAlchemy URL of the store, "sqlite:///friction-bench.sqlite".
    """
    prefix = "sqlite:///"
    if store_url.startswith(prefix) and store_url != prefix:
        return Path(store_url.removeprefix(prefix)).with_suffix(".token")
    return Path("friction-bench.token")


def chosen_token(path: Path) -> tuple[str, str] | None:
    """A token that somebody chose: from the environment, else from the file `path`. With the name that it goes by.

    Raises:
        ConfigurationError: the file can be read by others, or what it holds cannot be a token.
    """
    value = os.environ.get(TOKEN_VARIABLE)
    if value is not None:
        return ENVIRONMENT, checked_token(value.strip(), f"environment variable {TOKEN_VARIABLE}")
    found = read_token(path)
    return None if found is None else (TOKEN_FILE, found)
