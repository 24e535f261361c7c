"""The tokens that a service starts with."""

from typing import NamedTuple

from bench.service.auth.roles import Role
from bench.service.auth.tokens import digest_of, make_token
from bench.store import Store
from bench.store.tables.experiments import now

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
