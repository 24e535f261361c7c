"""Where things lie: in the repository, and the measured recordings beside it."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"
MEASURED = Path(os.environ.get("FRICTION_BENCH_DATA", ROOT.parent / "shared" / "data"))


def measured(name: str) -> Path:
    """The folder of a measured recording set; the test is skipped, with the reason, where it is absent."""
    folder = MEASURED / name
    if not folder.is_dir():
        pytest.skip(f"measured set '{name}' is not in {MEASURED}; name its place in FRICTION_BENCH_DATA")
    return folder
