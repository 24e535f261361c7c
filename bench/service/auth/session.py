"""The token with which commands of the same user reach a service on this machine, while it runs.

It lies in two files: beside the store, and in the user's own folder, where a command finds it that works in another
folder or with another store, as `friction-bench stop` does.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from bench.errors import ConfigurationError
from bench.own_service import own_file, read_token
from bench.service.auth.tokens import make_token, token_file


def session_file(store_url: str, port: int) -> Path:
    """Beside the store: the file of the service on `port`."""
    beside = token_file(store_url)
    return beside.with_name(f"{beside.stem}.port-{port}.token")


@contextmanager
def session_token(path: Path, own: Path | None = None) -> Iterator[str]:
    """A token of this process alone, in files that only its owner can read; files and token end with the block.

    Args:
        path: of the file beside the store.
        own: of that in the user's own folder; where it cannot be written, the first has to do.

    Raises:
        ConfigurationError: the file beside the store cannot be written.
    """
    token = make_token()
    try:
        _write(path, token)
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be written ({error.strerror}); make its folder writable") from error
    if own is not None:
        with suppress(OSError):
            own.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            _write(own, token)
    try:
        yield token
    finally:
        path.unlink(missing_ok=True)
        if own is not None:
            _remove(own, token)


def found_token(store_url: str, port: int) -> str | None:
    """The token of this user's service on `port`; None where it left none. The newer file is of what runs now.

    Raises:
        ConfigurationError: others can read the file, or what it holds cannot be a token.
    """
    files = [file for file in (session_file(store_url, port), own_file(port)) if file is not None and file.is_file()]
    newest = max(files, key=lambda file: file.stat().st_mtime_ns, default=None)
    return None if newest is None else read_token(newest)


def _write(path: Path, token: str) -> None:
    path.unlink(missing_ok=True)  # of a service that was killed
    # O_EXCL: never follow a link that somebody else has put there in the meantime
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(token + "\n")


def _remove(own: Path, token: str) -> None:
    """Unless it is by now that of another service, which has the same port of another address."""
    with suppress(OSError):
        if own.read_text(encoding="utf-8").strip() == token:
            own.unlink()
