"""The tokens that the service knows: in memory, so that a request that stops the joint waits for no database."""

import hmac
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from bench.service.auth.roles import Caller, Role
from bench.service.auth.tokens import digest_of
from bench.store.tables.access_tokens import AccessToken

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
        now: the time, UTC.
    """

    def __init__(
        self,
        fixed: Mapping[str, str],
        stored: Callable[[], Sequence[AccessToken]] = list,
        now: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self._fixed = [FixedToken(name, digest_of(token)) for name, token in fixed.items()]
        self._read = stored
        self._now = now
        self._stored: Sequence[AccessToken] = ()

    def refresh(self) -> None:
        """Read the tokens of the store again."""
        self._stored = self._read()

    def caller(self, presented: str) -> Caller | None:
        """Whose it is; None where it is nobody's. Takes the same time whichever digests differ, and wherever."""
        digest, moment = digest_of(presented), self._now()
        found: Caller | None = None
        known: list[FixedToken | AccessToken] = [*self._fixed, *self._stored]
        for token in known:
            if hmac.compare_digest(token.digest, digest) and token.is_valid(moment):
                found = Caller(token.name, Role(token.role))
        return found
