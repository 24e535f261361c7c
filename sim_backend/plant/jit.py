"""The one place where functions are handed to numba, with their types kept."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, TypeVar

import numba
import numpy as np
from numpy.typing import NDArray

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


def jitted_and_cached(function: Function) -> Function:
    """Compile a kernel on its first call and keep the machine code on disk for later starts.

    It keeps the interpreter's lock: to let go of it and take it again costs a fifth of a control cycle of the plant.
    """
    compiled: Function = numba.njit(function, cache=True, **_LEAN)
    return compiled


Records = NDArray[np.void]


def pack(component: Any) -> Records:
    """Return a dataclass, or a dataclass of dataclasses, as a structured array of shape (1,).

    Leaves keep their type where it is int64 or uint64; every other number or flag becomes a float64.
    """
    packed: Records = np.zeros(1, dtype=_layout(type(component)))  # type: ignore[arg-type]  # a type is hashable
    packed[0] = _values(component)
    return packed


# one object per type: numba knows a record by the identity of its dtype, and compares field by field otherwise
@cache
def _layout(kind: Any) -> np.dtype[np.void]:
    return np.dtype([(item.name, _leaf(item.type)) for item in fields(kind)])


def _leaf(kind: Any) -> Any:
    if is_dataclass(kind):
        return _layout(kind)  # type: ignore[arg-type]
    return kind if issubclass(kind, np.integer) else np.float64


def _values(component: Any) -> tuple[Any, ...]:
    values = (getattr(component, item.name) for item in fields(component))
    return tuple(_values(value) if is_dataclass(value) else value for value in values)
