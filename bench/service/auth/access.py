"""Who may do what: whose token it is, what its role allows; and where nobody may listen without tokens."""

import math
from dataclasses import dataclass, field
from typing import Annotated, cast

import anyio
import anyio.to_thread
from fastapi import Depends, HTTPException, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from bench.errors import ConfigurationError
from bench.own_service import LOOPBACK_NAMES, is_loopback
from bench.service.auth.attempts import Attempts
from bench.service.auth.token_register import TokenRegister
from bench.service.auth.tokens import Caller, Role
from bench.store.errors import StoreError

LOOK_AGAIN_S = 1.0  # what the database is given to tell of a token that was made just now

_bearer = HTTPBearer(
    auto_error=False,
    scheme_name="token",
    description="The token that `friction-bench serve` printed at its first start, or one of `friction-bench token "
    "new`: `Authorization: Bearer <token>`.",
)
Credentials = Annotated[HTTPAuthorizationCredentials | None, Depends(_bearer)]


@dataclass(frozen=True)
class Access:
    """What the service lets pass.

    Attributes:
        reads_open: True where reading needs no token (loopback only).
        hosts: host names under which the service may be addressed.
        strangers: requests without a token so far.
    """

    tokens: TokenRegister
    reads_open: bool = True
    hosts: frozenset[str] = LOOPBACK_NAMES
    attempts: Attempts = field(default_factory=Attempts)
    strangers: Attempts = field(default_factory=Attempts)
    _looking: anyio.CapacityLimiter = field(default_factory=lambda: anyio.CapacityLimiter(1))

    async def caller(self, presented: str, address: str) -> Caller | None:
        """Whose token it is; None where it is nobody's.

        A right one is found in memory, and never waits. For another one the store is read again: it may be new.

        Raises:
            HTTPException: 429, too many wrong ones came from the address.
        """
        found = self.tokens.caller(presented)
        if found is not None:
            return found
        wait_s = math.ceil(self.attempts.wait_s(address))
        if wait_s:
            raise HTTPException(
                429, f"too many wrong tokens came from {address}; wait {wait_s} s", {"Retry-After": str(wait_s)}
            )
        self.attempts.failed(address)
        await self._look_at_once()
        return self.tokens.caller(presented)

    async def _look_at_once(self) -> None:
        with anyio.move_on_after(LOOK_AGAIN_S):
            await anyio.to_thread.run_sync(self.look_again, abandon_on_cancel=True, limiter=self._looking)

    def look_again(self) -> None:
        """Read the tokens of the store; where it cannot be read, those that were known stay."""
        try:
            self.tokens.refresh()
        except StoreError:
            return


def check_bind(host: str, token_configured: bool, private: bool = True) -> None:
    """Refuse to listen beyond loopback without a token that somebody made or chose before, or in the clear.

    Args:
        host: to listen on.
        token_configured: whether there is a token.
        private: the connection is encrypted, or its owner says that nobody else is on the line.

    Raises:
        ConfigurationError: names the address and the ways out.
    """
    if is_loopback(host):
        return
    if token_configured and private:
        return
    if token_configured:
        raise ConfigurationError(
            f"host is {host}, without TLS: whoever is on the network could read the tokens, and move the joint with "
            "them. Give --tls-certificate and --tls-key; or say --plain-http where the network is the bench's own"
        )
    raise ConfigurationError(
        f"host is {host}; allowed without a token is loopback only (127.0.0.1, ::1, localhost). "
        "Make one with: friction-bench token new NAME --role admin; or set FRICTION_BENCH_TOKEN"
    )


# async on purpose, here and below: a plain function would wait for a free worker thread, and STOP must not
async def _identified(request: Request, credentials: HTTPAuthorizationCredentials | None, what: str) -> Caller:
    access: Access = request.app.state.access
    if credentials is None:
        raise _unauthorised(what, "no token was sent")
    found = None
    if not getattr(request.state, "wrong_token", False):  # else it was looked at, and counted, before the body was read
        found = await access.caller(credentials.credentials, request.client.host if request.client else "")
    if found is None:
        raise _unauthorised(what, "the token is none of this service, was revoked or has expired")
    request.state.caller = found
    return found


class Require:
    """Dependency of a route: a token of this role, or a higher one."""

    def __init__(self, role: Role) -> None:
        self._role = role

    async def __call__(self, request: Request, credentials: Credentials) -> Caller:
        """Whose token it is.

        Raises:
            HTTPException: 401, 403 or 429.
        """
        found = await _identified(request, credentials, "this")
        self.check(found)
        return found

    def check(self, caller: Caller) -> None:
        """Pass where the caller has the role.

        Raises:
            HTTPException: 403.
        """
        if caller.role < self._role:
            raise HTTPException(
                403,
                f"token '{caller.name}' has the role {caller.role}; this takes the role {self._role}. "
                f"Ask an admin for one: friction-bench token new NAME --role {self._role}",
            )


require_viewer = Require(Role.VIEWER)
require_operator = require_token = Require(Role.OPERATOR)  # `require_token`: of every route that changes something
require_admin = Require(Role.ADMIN)

Viewer = Annotated[Caller, Depends(require_viewer)]
Operator = Annotated[Caller, Depends(require_operator)]


async def allow_read(request: Request, credentials: Credentials) -> None:
    """Dependency of every route that only reads."""
    if not cast(Access, request.app.state.access).reads_open:
        await _identified(request, credentials, "reading beyond loopback")


def _unauthorised(what: str, found: str) -> HTTPException:
    return HTTPException(
        status_code=401,
        detail=f"{what} needs a token, and {found}; "
        "send 'Authorization: Bearer <token>' with the token that 'friction-bench serve' printed at its first start, "
        "or make one with: friction-bench token new NAME. Commands send the one in FRICTION_BENCH_TOKEN",
        headers={"WWW-Authenticate": "Bearer"},
    )
