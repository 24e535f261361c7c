"""Whom a client of a service trusts to be that service."""

import ssl


def trusted(url: str, ca_file: str | None = None) -> ssl.SSLContext | bool:
    """What httpx is told to verify answers by: True for the authorities of the system.

    It reads all of these for every client, in 20 ms, also where the connection is a plain one and none of them is
    asked: there it is told to trust nobody.

    Args:
        url: of the service.
        ca_file: certificate, in PEM, that vouches for it; None: those of the system.
    """
    if ca_file is not None:
        return ssl.create_default_context(cafile=ca_file)
    return ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT) if url.lower().startswith("http:") else True


def trusted_alone(certificate: str) -> ssl.SSLContext:
    """Trust a service that shows this very certificate, by whatever name it is reached.

    Args:
        certificate: in PEM, as the service itself has told it.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    context.load_verify_locations(cadata=certificate)
    return context
