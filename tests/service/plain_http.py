"""Clients over plain HTTP: unless told whom they trust, each reads all authorities of the machine, in 20 ms."""

import ssl

NOBODY = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
"""Trusts none of them: with it, whatever speaks TLS is refused."""
