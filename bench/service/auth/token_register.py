"""The tokens that the service knows: in memory, so that a request that stops the joint waits for no database."""

import hmac
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import NamedTuple

from bench.service.auth.tokens import Caller, Role, digest_of, make_token
from bench.store import Store
from bench.store.tables.access_tokens import AccessToken
from bench.store.tables.experiments import now

REFRESH_S = 2.0  # after which a token that was revoked from outside opens nothing any more


@dataclass(frozen=True, slots=True)
class FixedToken:
    """A token that is not in the store: of the environment, of a file, of this process."""

    name: str
    digest: str
    role: Role = Role.ADMIN

    def is_valid(self, at_utc: datetime) -> bool:  # noqa: ARG002  as those of the store
        """As long as the service runs."""
        return True


class TokenRegister:
    """Finds out whose token it is.

    Args:
        fixed: tokens by name, all of them admins.
        stored: reads those of the store.
    """

    def __init__(self, fixed: Mapping[str, str], stored: Callable[[], Sequence[AccessToken]] = list) -> None:
        self._fixed = [FixedToken(name, digest_of(token)) for name, token in fixed.items()]
        self._read = stored
        self._stored: Sequence[AccessToken] = ()

    def refresh(self) -> None:
        """Read the tokens of the store again."""
        self._stored = self._read()

    def caller(self, presented: str) -> Caller | None:
        """Whose it is; None where it is nobody's. Takes the same time whichever digests differ, and wherever."""
        digest, moment = digest_of(presented), datetime.now(UTC)
        found: Caller | None = None
        known: list[FixedToken | AccessToken] = [*self._fixed, *self._stored]
        for token in known:
            if hmac.compare_digest(token.digest, digest) and token.is_valid(moment):
                found = Caller(token.name, Role(token.role))
        return found


FIRST_NAME = "first"


class Tokens(NamedTuple):
    """What is known at the start.

    Attributes:
        chosen: name and token that somebody chose (environment, file); None: nobody did.
        made: the token that was made just now, to be shown once; None: there were some already.
    """

    chosen: tuple[str, str] | None
    made: str | None


def has_valid_token(store: Store) -> bool:
    """Whether somebody can come in with a token of the store."""
    return any(token.is_valid(now()) for token in store.access.tokens.find())


def first_token(store: Store, chosen: tuple[str, str] | None) -> Tokens:
    """Make an admin's token where there is none of any kind."""
    if chosen is not None or has_valid_token(store):
        return Tokens(chosen, None)
    token = make_token()
    count = len(store.access.tokens.find())  # those before were revoked or have expired; their names are taken
    name = f"{FIRST_NAME}-{count + 1}" if count else FIRST_NAME
    store.access.tokens.add(name, Role.ADMIN, digest_of(token))
    return Tokens(None, token)
