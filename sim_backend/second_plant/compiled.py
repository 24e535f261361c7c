"""How functions of the plant are compiled: without checks for division by zero, which the physics excludes."""

import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile at the first call, into what calls it. It cannot be called from Python.

    Without a wrapper for Python around each function, the plant is compiled in half the time.
    """
    return _made(function, kept=False)


def compiled_and_kept(function: Callable[P, R]) -> Callable[P, R]:
    """Compile at the first call and keep the machine code on disk for later starts.

    Numba notices that a file has changed, but not one of which its functions are called. The value of a closure's
    variable is part of its key, though: name `SOURCES` there.
    """
    return _made(function, kept=True)


def _made(function: Callable[P, R], kept: bool) -> Callable[P, R]:
    lean: Any = njit  # numba knows these options, its type hints do not
    made: Callable[P, R] = lean(
        function,
        cache=kept,
        error_model="numpy",
        fastmath={"contract", "arcp"},
        no_cpython_wrapper=not kept,
        no_cfunc_wrapper=True,
        no_rewrites=True,
    )
    return made


def _fingerprint() -> int:
    digest = 0
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest = zlib.crc32(path.read_bytes(), digest)
    return digest


SOURCES = _fingerprint()
"""A number that changes with any source file of this plant."""
