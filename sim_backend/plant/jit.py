"""The one place where functions are handed to numba, with their types kept."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

# numba knows these options, its type hints do not
_LEAN: dict[str, Any] = {"error_model": "numpy", "no_cfunc_wrapper": True, "no_rewrites": True}
_MECHANISM: dict[str, Any] = {"forceinline": True, "no_cpython_wrapper": True}


def jitted(function: Function) -> Function:
    """Compile a small function of the kernel into its callers. It cannot be called from Python.

    What it saves: calls between mechanisms, half the time of a step; a wrapper for Python around each, half the time
    that compiling takes; a look for array expressions and exceptions, of which there are none.
    """
    compiled: Function = numba.njit(function, **_MECHANISM, **_LEAN)
    return compiled


def jitted_and_cached(function: Function, nogil: bool = False) -> Function:
    """Compile a kernel on its first call and keep the machine code on disk for later starts.

    Args:
        function: the kernel.
        nogil: let other threads run meanwhile; to let go of the interpreter's lock and take it again costs a fifth of
            what a control cycle of the plant does, and the wait for whoever took it.
    """
    compiled: Function = numba.njit(function, cache=True, nogil=nogil, **_LEAN)
    return compiled
