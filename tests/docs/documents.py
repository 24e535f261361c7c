"""The documents that people read in the repository, and what is found in them."""

import re
from pathlib import Path

from tests.paths import ROOT

GENERATED = ROOT / "docs" / "reference" / "generated"
DOCUMENTS = sorted(
    [
        *ROOT.glob("*.md"),
        *(file for file in (ROOT / "docs").rglob("*.md") if GENERATED not in file.parents),
    ]
)


def text_of(file: Path) -> str:
    return file.read_text(encoding="utf-8")


def name_of(file: Path) -> str:
    return file.relative_to(ROOT).as_posix()


def commands_in(text: str) -> list[str]:
    """Lines of code that call friction-bench, with continued lines joined and comments taken off."""
    joined = re.sub(r"\\\n\s*", "", text)
    lines = re.findall(r"^(?: {4,}|)(friction-bench .*)$", joined, re.MULTILINE)
    parts = [part.strip() for line in lines for part in re.sub(r"\s+#.*", "", line).split("&&")]
    return [part for part in parts if part.startswith("friction-bench ")]
