"""Where a result comes from: software, versions, configuration, drive, seed. Nothing about the machine's user."""

import copy
import dataclasses
import functools
import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from bench import __version__
from bench.json_types import Value
from drivers.contract import Description

LIBRARIES = (
    "numpy", "scipy", "numba", "pydantic", "sqlalchemy", "alembic", "tsdownsample",
    "python-can", "canopen", "pyserial", "pymodbus",
)  # fmt: skip
_ROOT = Path(__file__).resolve().parent.parent
_GIT_TIMEOUT_S = 5.0


Provenance = dict[str, Any]
"""What `provenance` makes, as the store gives it back: tables of JSON by name."""


def provenance(
    configuration: BaseModel | None = None,
    drive: Description | None = None,
    seed: int | None = None,
    master: Description | None = None,
) -> dict[str, Value]:
    """What an experiment was made with, JSON-able.

    Where the store lies is left out of the configuration: it says where the user's files are, and
    may hold a password.
    """
    found: dict[str, Value] = {"software": software()}
    if configuration is not None:
        found["configuration"] = configuration.model_dump(mode="json", exclude_none=True, exclude={"store"})
    if drive is not None:
        found["drive"] = _drive(drive)
    if master is not None:
        found["master_drive"] = _drive(master)
    if seed is not None:
        found["seed"] = seed
    return found


@functools.cache
def _software() -> dict[str, Value]:
    return {
        "version": __version__,
        **_commit(),
        "python": platform.python_version(),
        "libraries": {name: found for name in LIBRARIES if (found := _version(name)) is not None},
        "host_os": _operating_system(),
    }


def software() -> dict[str, Value]:
    """Version, and the commit where it runs from a git checkout; Python, libraries and operating system."""
    return copy.deepcopy(_software())


def _version(distribution: str) -> str | None:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return None


def _commit() -> dict[str, Value]:
    if not (_ROOT / ".git").exists():  # installed: the version says it all
        return {}
    commit = _git("rev-parse", "HEAD")
    if commit is None:
        return {}
    changes = _git("status", "--porcelain", "--untracked-files=no")
    return {"commit": commit, "uncommitted_changes": None if changes is None else changes != ""}


def _git(*arguments: str) -> str | None:
    command = ["git", "-C", str(_ROOT), *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_GIT_TIMEOUT_S, check=True)  # noqa: S603
    except (OSError, subprocess.SubprocessError):
        return None  # no git on this machine, or not a checkout that it trusts
    return done.stdout.strip()


def _operating_system() -> str:
    try:
        name = platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        name = platform.system()
    return f"{name} ({platform.machine()})"


def _drive(drive: Description) -> dict[str, Value]:
    found = dataclasses.asdict(drive)
    found["modes"] = sorted(mode.value for mode in drive.modes)
    found["measured"] = sorted(drive.measured)
    for name in ("tables", "counts_per_turn"):  # for whoever commissions the drive
        del found[name]
    return found
