"""Mechanisms of the kernel, which are compiled into their callers, made callable from Python."""

from typing import Any, TypeVar

import numba

Function = TypeVar("Function")


def callable_from_python(function: Function) -> Function:
    """The same function with a caller around it."""

    def call(*arguments: Any) -> Any:
        return function(*arguments)  # type: ignore[operator]

    return numba.njit(call, error_model="numpy")  # type: ignore[no-any-return]
