"""The data sheets of real drives, where there are any."""

import os
from pathlib import Path

FOLDER = "FRICTION_BENCH_DICTIONARIES"


def sheets_in(folder: Path) -> list[Path]:
    """Data sheets and configuration files of a folder."""
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in (".eds", ".dcf"))


def real_sheets() -> list[Path]:
    """Those of the folder that the environment names; none without it."""
    named = os.environ.get(FOLDER)
    return sheets_in(Path(named)) if named else []
