"""Dataclasses as numpy records, which compiled code reads as `parameters.motor.resistance_ohm`.

One record instead of sixty arguments: a call of the kernel costs a microsecond, and a new component reaches the
kernel without touching any signature. Compiled functions are annotated with the dataclass whose record they are given.
"""

from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
