"""The bearer token that every state-changing call needs: made once, kept in a file only its owner can read."""

import os
import re
import secrets
import stat
from pathlib import Path

from bench.errors import ConfigurationError

TOKEN_VARIABLE = "FRICTION_BENCH_TOKEN"  # noqa: S105  the name of a variable, not a token
_PERMITTED = re.compile(r"[A-Za-z0-9._~+/=-]{16,256}")


def token_file(store_url: str) -> Path:
    """The token's file: next to an SQLite store, else in the working directory.

    Args:
        store_url: SQLAlchemy URL of the store, "sqlite:///friction-bench.sqlite".
    """
    prefix = "sqlite:///"
    if store_url.startswith(prefix) and store_url != prefix:
        return Path(store_url.removeprefix(prefix)).with_suffix(".token")
    return Path("friction-bench.token")


def find_token(path: Path) -> str | None:
    """The configured token: the environment variable first, then the file; None where there is neither.

    Raises:
        ConfigurationError: the file can be read by others, or what it holds cannot be a token.
    """
    value = os.environ.get(TOKEN_VARIABLE)
    if value is not None:
        return _checked(value.strip(), f"environment variable {TOKEN_VARIABLE}")
    if not path.exists():
        return None
    mode = stat.S_IMODE(path.stat().st_mode)
    if os.name == "posix" and mode & 0o077:
        raise ConfigurationError(
            f"{path}: mode is {mode:04o}; allowed is 0600, because others could read the token. "
            f"Delete the file to get a new token, or run: chmod 600 {path}"
        )
    return _checked(path.read_text(encoding="utf-8").strip(), str(path))


def find_or_make_token(path: Path) -> str:
    """The configured token, or a new one written to `path` with mode 0600."""
    token = find_token(path)
    if token is not None:
        return token
    token = secrets.token_urlsafe(24)
    # O_EXCL: never follow a link that somebody else has put there in the meantime
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(token + "\n")
    return token


def _checked(token: str, where: str) -> str:
    if not _PERMITTED.fullmatch(token):
        raise ConfigurationError(
            f"{where}: the token has {len(token)} characters; wanted are 16 to 256 letters, digits or ._~+/=- "
            "(make one with: python -c 'import secrets; print(secrets.token_urlsafe(24))')"
        )
    return token
