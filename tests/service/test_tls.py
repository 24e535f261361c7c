"""https by certificate files."""

import os
import shutil
import ssl
import subprocess
from pathlib import Path

import httpx
import pytest

from bench.errors import ConfigurationError
from bench.service.auth.tls import Certificate, certificate
from tests.service.running_service import running_service

OPENSSL = shutil.which("openssl")
pytestmark = pytest.mark.skipif(OPENSSL is None, reason="needs openssl")


def make(folder: Path, name: str) -> Certificate:
    """A self-signed certificate for 127.0.0.1."""
    made = Certificate(folder / f"{name}.pem", folder / f"{name}.key")
    subject = ["-subj", f"/CN={name}", "-addext", "subjectAltName=IP:127.0.0.1"]
    kind = ["-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2"]
    files = ["-keyout", str(made.key), "-out", str(made.chain)]
    subprocess.run([str(OPENSSL), "req", *kind, *subject, *files], check=True, capture_output=True)
    os.chmod(made.key, 0o600)
    return made


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    return make(tmp_path_factory.mktemp("tls"), "bench")


def test_the_service_speaks_https_and_nothing_else(own, tmp_path):
    trusted = ssl.create_default_context(cafile=own.chain)
    with running_service(tmp_path, tls=own, trust=trusted) as service:
        assert service.url.startswith("https://")
        assert service.client.get("/bench").status_code == 200
        origin = {"Origin": service.url, "Sec-Fetch-Site": "same-origin"}
        assert service.client.post("/stop", headers=origin).status_code == 200
        with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
            httpx.get(f"{service.url}/api/v1/bench")
        with pytest.raises(httpx.HTTPError):
            httpx.get(f"{service.url.replace('https', 'http')}/api/v1/bench")


def test_files_that_cannot_be_used_are_named(own, tmp_path):
    assert certificate(None, None) is None
    assert certificate(own.chain, own.key) == own
    with pytest.raises(ConfigurationError, match="belong together"):
        certificate(own.chain, None)
    with pytest.raises(ConfigurationError, match="there is no such file"):
        certificate(tmp_path / "none.pem", own.key)
    other = make(tmp_path, "other")
    with pytest.raises(ConfigurationError, match="cannot be used"):
        certificate(own.chain, other.key)
    os.chmod(other.key, 0o644)
    with pytest.raises(ConfigurationError, match="chmod 640"):
        certificate(other.chain, other.key)


def test_a_key_with_a_password_is_refused_without_asking(own, tmp_path):
    locked = tmp_path / "locked.key"
    command = [str(OPENSSL), "pkey", "-in", str(own.key), "-aes256", "-passout", "pass:x", "-out", str(locked)]
    subprocess.run(command, check=True, capture_output=True)
    os.chmod(locked, 0o600)
    with pytest.raises(ConfigurationError, match="locked by a password"):
        certificate(own.chain, locked)
