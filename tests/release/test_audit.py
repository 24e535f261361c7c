"""What `make audit` says, for each way in which pip-audit may end."""

import sys

import pytest

from tests.release.audit import FOUND, NOT_LOOKED_UP, audit

NONE = "No known vulnerabilities found"
MIRROR = "ERROR:pip_audit._cli:anyio: Dependency not found on PyPI and could not be audited: anyio (4.1.0)"
OFFLINE = "ERROR: HTTPSConnectionPool(host='pypi.org', port=443): Max retries exceeded with url: /pypi/anyio/json"


@pytest.mark.parametrize(
    ("code", "said", "ends", "words"),
    [
        (0, NONE, 0, NONE),
        (1, "Found 1 known vulnerability in 1 package", FOUND, "Found 1 known"),
        (1, MIRROR, NOT_LOOKED_UP, "Nothing was looked up: of the 2 pins"),
        (1, OFFLINE, NOT_LOOKED_UP, "run `make audit` where pypi.org is reached"),
    ],
)
def test_it_is_said_whether_anybody_was_asked(tmp_path, capsys, code, said, ends, words):
    pins = tmp_path / "hashes.txt"
    pins.write_text("anyio==4.1.0 --hash=sha256:0\nidna==3.1 --hash=sha256:0\n", encoding="utf-8")
    program = f"import sys; sys.stderr.write({said!r}); sys.exit({code})"
    assert audit((sys.executable, "-c", program), str(pins)) == ends
    assert words in capsys.readouterr().out
