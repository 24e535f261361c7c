"""Known vulnerabilities of the pinned versions: `python -m tests.release.audit`, or `make audit`.

pip-audit asks PyPI for each pin. Where nobody can be asked, or the registry in reach is a mirror that tells no
advisories, nothing is known of the pins, which is no pass: it is said in words, with another exit code than a hole.
"""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

PROGRAM = str(Path(sys.executable).with_name("pip-audit"))
WORDS = (PROGRAM, "--strict", "--disable-pip", "--require-hashes", "--progress-spinner", "off", "--requirement")
PINS = "hashes.txt"
FOUND, NOT_LOOKED_UP = 1, 2
# what pip-audit says where a version cannot be looked up, or PyPI cannot be reached
UNKNOWN = ("could not be audited", "Connection", "connection", "Max retries", "timed out", "Name or service")


def main() -> None:
    """Ask, print what was answered, and end with 0 (no known hole), 1 (holes) or 2 (nobody could be asked)."""
    sys.exit(audit(WORDS, PINS))


def audit(words: Sequence[str], pins: str) -> int:
    """What came of it, printed.

    Args:
        words: of the program, before the file.
        pins: file with a version and its hashes a line.
    """
    found = subprocess.run([*words, pins], capture_output=True, text=True, check=False)
    told = found.stdout.strip(), found.stderr.strip()
    if found.returncode and any(one in told[1] for one in UNKNOWN):
        count = sum("==" in line for line in Path(pins).read_text(encoding="utf-8").splitlines())
        print(
            f"Nothing was looked up: of the {count} pins nobody here tells known vulnerabilities, neither that there "
            "are some nor that there are none. This is no network, or a mirror of PyPI without its advisories; run "
            f"`make audit` where pypi.org is reached.\npip-audit: {told[1].splitlines()[-1]}"
        )
        return NOT_LOOKED_UP
    print("\n".join(filter(None, told)))
    return FOUND if found.returncode else 0


if __name__ == "__main__":
    main()
