"""The pinned versions have hashes, and no address of a registry is anywhere near them."""

import re

from tests.paths import ROOT

CONSTRAINTS = (ROOT / "constraints.txt").read_text(encoding="utf-8")
HASHES = (ROOT / "hashes.txt").read_text(encoding="utf-8")
PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s\\;]+)", re.MULTILINE)


def pins(text: str) -> dict[str, str]:
    """Version by name, written alike."""
    return {re.sub(r"[-_.]+", "-", name).lower(): version for name, version in PIN.findall(text)}


def test_every_pinned_version_has_hashes() -> None:
    """After a change of constraints.txt: `make hashes`."""
    assert pins(HASHES) == pins(CONSTRAINTS)
    for part in re.split(r"\n(?=\S)", HASHES.strip()):
        assert re.fullmatch(r"\S+==\S+ \\\n(    --hash=sha256:[0-9a-f]{64}( \\\n)?)+", part), part[:80]


def test_no_address_is_in_them() -> None:
    assert "://" not in CONSTRAINTS + HASHES
    assert "index" not in HASHES
