"""The service of this user on this machine, and the token that it leaves for the user's other programs."""

import ipaddress
import os
import re
import stat
from pathlib import Path
from urllib.parse import urlsplit

from bench.errors import ConfigurationError

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
_PERMITTED = re.compile(r"[A-Za-z0-9._~+/=-]{16,256}")


def is_loopback(host: str) -> bool:
    """True where only this machine can reach the address."""
    if host in LOOPBACK_NAMES:
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def local_port(url: str) -> int | None:
    """The port of a service on this machine; None where it is on another one, which is not to be sent the token.

    Raises:
        ValueError: it is no address of a service.
    """
    parts = urlsplit(url)
    port = parts.port or (443 if parts.scheme == "https" else 80)
    return port if is_loopback(parts.hostname or "") else None


def own_folder() -> Path | None:
    """The user's own folder, where running processes leave word of themselves; None where the user has no home."""
    state = os.environ.get("XDG_STATE_HOME", "")
    try:
        folder = Path(state) if Path(state).is_absolute() else Path.home() / ".local" / "state"
    except RuntimeError:
        return None
    return folder / "friction-bench"


def own_file(port: int) -> Path | None:
    """In the user's own folder: the file of the service on `port`; None where the user has no home."""
    folder = own_folder()
    return None if folder is None else folder / f"port-{port}.token"


def read_token(path: Path) -> str | None:
    """The token in a file; None where there is no file.

    Raises:
        ConfigurationError: the file can be read by others, or what it holds cannot be a token.
    """
    if not path.exists():
        return None
    mode = stat.S_IMODE(path.stat().st_mode)
    if os.name == "posix" and mode & 0o077:
        raise ConfigurationError(
            f"{path}: mode is {mode:04o}; allowed is 0600, because others could read the token. "
            f"Delete the file to get a new token, or run: chmod 600 {path}"
        )
    return checked_token(path.read_text(encoding="utf-8").strip(), str(path))


def checked_token(token: str, where: str) -> str:
    """A token that can be one.

    Raises:
        ConfigurationError: it cannot; the message names `where` it stands.
    """
    if not _PERMITTED.fullmatch(token):
        raise ConfigurationError(
            f"{where}: the token has {len(token)} characters; wanted are 16 to 256 letters, digits or ._~+/=- "
            "(make one with: python -c 'import secrets; print(secrets.token_urlsafe(32))')"
        )
    return token
