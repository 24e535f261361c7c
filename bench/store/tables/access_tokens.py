"""Tokens in the store: names, roles and digests, never a token itself."""

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import select, update
from sqlalchemy.exc import IntegrityError

from bench.store.database import Database
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.schema import ACCESS_TOKEN
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row, now


@dataclass(frozen=True, slots=True)
class AccessToken:
    """One token.

    Attributes:
        digest: SHA-256 of the token, hexadecimal.
        expires_utc: None: never.
        revoked_utc: None: not revoked.
    """

    id: int
    name: str
    role: str
    digest: str
    created_utc: datetime
    expires_utc: datetime | None
    revoked_utc: datetime | None

    def is_valid(self, at_utc: datetime) -> bool:
        """Neither revoked nor expired."""
        return self.revoked_utc is None and (self.expires_utc is None or at_utc < self.expires_utc)


class AccessTokens:
    """`Store.access.tokens`. Every method may be called from any thread."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, name: str, role: str, digest: str, expires_utc: datetime | None = None) -> int:
        """Keep one. Returns its id.

        Raises:
            StoreValueError: the name was given before, also to a token that is revoked.
        """
        row = {"name": name, "role": role, "digest": digest, "created_utc": now(), "expires_utc": expires_utc}
        try:
            with self._database.writing() as connection:
                token_id = insert_row(connection, ACCESS_TOKEN, row)
                chain.seal(connection, "access_token", [token_id])
                return token_id
        except IntegrityError as error:
            raise StoreValueError(
                f"there is or was a token '{name}'; choose another name, so that the audit log stays clear"
            ) from error

    def find(self) -> list[AccessToken]:
        """All, in the order in which they were made; those that expired or were revoked too."""
        with self._database.reading() as connection:
            return [AccessToken(**row._asdict()) for row in connection.execute(select(ACCESS_TOKEN).order_by("id"))]

    def revoke(self, name: str) -> None:
        """It opens nothing any more.

        Raises:
            NotFoundError: there is none of that name.
            StoreStateError: it is revoked already.
        """
        found = next((token for token in self.find() if token.name == name), None)
        if found is None:
            raise NotFoundError(f"there is no token '{name}'; see: friction-bench token list")
        if found.revoked_utc is not None:
            raise StoreStateError(f"token '{name}' is revoked already, since {found.revoked_utc:%Y-%m-%d %H:%M} UTC")
        with self._database.writing() as connection:
            connection.execute(update(ACCESS_TOKEN).where(ACCESS_TOKEN.c.id == found.id).values(revoked_utc=now()))
            chain.seal(connection, "access_token", [found.id])
