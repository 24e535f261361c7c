"""Who may do what: the token check, and the refusal to listen where it could be bypassed."""

import ipaddress
import secrets
from dataclasses import dataclass, field
from typing import Annotated

from fastapi import Depends, HTTPException, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from bench.errors import ConfigurationError

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})

_bearer = HTTPBearer(
    auto_error=False,
    scheme_name="token",
    description="The token that `friction-bench serve` prints at its start: `Authorization: Bearer <token>`.",
)
Credentials = Annotated[HTTPAuthorizationCredentials | None, Depends(_bearer)]


@dataclass(frozen=True)
class Access:
    """What the service lets pass.

    Attributes:
        token: the bearer token for everything that changes state.
        reads_open: True where reading needs no token (loopback only).
        hosts: host names under which the service may be addressed.
    """

    token: str = field(repr=False)
    reads_open: bool = True
    hosts: frozenset[str] = LOOPBACK_NAMES

    def admits(self, presented: str | None) -> bool:
        """True for the right token; takes the same time for every wrong one."""
        return presented is not None and secrets.compare_digest(presented.encode(), self.token.encode())


def is_loopback(host: str) -> bool:
    """True where only this machine can reach the address."""
    if host in LOOPBACK_NAMES:
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def check_bind(host: str, token_configured: bool) -> None:
    """Refuse to listen beyond loopback without a token that somebody chose to configure.

    Raises:
        ConfigurationError: names the address and the two ways out.
    """
    if is_loopback(host) or token_configured:
        return
    raise ConfigurationError(
        f"host is {host}; allowed without a configured token is loopback only (127.0.0.1, ::1, localhost). "
        "Start once on loopback (this makes the token file), or set FRICTION_BENCH_TOKEN"
    )


# async on purpose, here and below: a plain function would wait for a free worker thread, and STOP must not
async def require_token(request: Request, credentials: Credentials) -> None:
    """Dependency of every route that changes state."""
    access: Access = request.app.state.access
    if not access.admits(credentials.credentials if credentials else None):
        raise _unauthorised("changing state", wrong=credentials is not None)


async def allow_read(request: Request, credentials: Credentials) -> None:
    """Dependency of every route that only reads."""
    access: Access = request.app.state.access
    if not access.reads_open and not access.admits(credentials.credentials if credentials else None):
        raise _unauthorised("reading beyond loopback", wrong=credentials is not None)


def _unauthorised(what: str, wrong: bool) -> HTTPException:
    found = "the token is not the one of this service" if wrong else "no token was sent"
    return HTTPException(
        status_code=401,
        detail=f"{what} needs a token, and {found}; "
        "send 'Authorization: Bearer <token>' with the token that 'friction-bench serve' printed",
        headers={"WWW-Authenticate": "Bearer"},
    )
