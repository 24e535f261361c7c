"""The one place where functions are handed to numba, with their types kept."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

# numba knows these options, its type hints do not
_MECHANISM: dict[str, Any] = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_KERNEL: dict[str, Any] = {"cache": True, "nogil": True, "no_cfunc_wrapper": True}


def jitted(function: Function) -> Function:
    """Compile a small function of the kernel into its callers. It cannot be called from Python.

    What it saves: calls between mechanisms, half the time of a step; a wrapper for Python around each, half the time
    that compiling takes.
    """
    compiled: Function = numba.njit(function, error_model="numpy", **_MECHANISM)
    return compiled


def jitted_and_cached(function: Function) -> Function:
    """Compile a kernel on its first call and keep the machine code on disk for later starts."""
    compiled: Function = numba.njit(function, error_model="numpy", **_KERNEL)
    return compiled
