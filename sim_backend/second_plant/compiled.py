"""How functions of the plant are compiled: without checks for division by zero, which the physics excludes."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile at the first call.

    Nothing is kept on disk: numba notices that a file has changed, but not one of which its functions are called.
    """
    made: Callable[P, R] = njit(error_model="numpy", fastmath={"contract", "arcp"})(function)
    return made
