"""TLS by certificate files, checked before anything is served."""

import os
import ssl
import stat
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from bench.errors import ConfigurationError


class Certificate(NamedTuple):
    """Files in PEM.

    Attributes:
        chain: the certificate of this service first, then those that lead to its authority.
        key: its private key, without a password.
    """

    chain: Path
    key: Path


def certificate(chain: Path | None, key: Path | None) -> Certificate | None:
    """The files, when both are named and fit each other; None where neither is.

    Raises:
        ConfigurationError: names the file, and what is wrong with it.
    """
    if chain is None and key is None:
        return None
    if chain is None or key is None:
        raise ConfigurationError("--tls-certificate and --tls-key belong together; name both, or neither")
    for path in (chain, key):
        if not path.is_file():
            raise ConfigurationError(f"{path}: there is no such file; name a file in PEM")
    mode = stat.S_IMODE(key.stat().st_mode)
    if os.name == "posix" and mode & 0o007:
        raise ConfigurationError(f"{key}: mode is {mode:04o}, so that everybody can read the key; run: chmod 640 {key}")
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(chain, key, password=_no_password(key))
    except (ssl.SSLError, OSError) as error:
        told = getattr(error, "reason", None) or error.strerror or error
        raise ConfigurationError(
            f"{chain} and {key} cannot be used: {told}; wanted are a certificate and its own key, in PEM"
        ) from error
    return Certificate(chain, key)


def _no_password(key: Path) -> Callable[[], str]:
    def refuse() -> str:
        raise ConfigurationError(f"{key}: is locked by a password; store it without one: openssl pkey -in {key}")

    return refuse
