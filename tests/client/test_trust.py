"""A client reads the authorities of the system only where they are asked, and trusts nobody over a plain connection."""

import ssl

from bench.trust import trusted


def test_over_a_plain_connection_nobody_is_trusted():
    for url in ("http://127.0.0.1:8000", "HTTP://bench"):
        nobody = trusted(url)
        assert isinstance(nobody, ssl.SSLContext)
        assert nobody.cert_store_stats()["x509_ca"] == 0
        assert nobody.verify_mode is ssl.CERT_REQUIRED
        assert nobody.check_hostname


def test_over_tls_the_authorities_of_the_system_are():
    assert trusted("https://bench:8000") is True
