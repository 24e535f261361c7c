"""Dataclasses as numpy records, which compiled code reads as `parameters.motor.resistance_ohm`.

One record instead of sixty arguments: a call of the kernel costs a microsecond, and a new component reaches the
kernel without touching any signature. Compiled functions are annotated with the dataclass whose record they are given.
"""

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Records = NDArray[np.void]


def pack(component: Any) -> Records:
    """Return a dataclass, or a dataclass of dataclasses, as a structured array of shape (1,).

    Leaves keep their type where it is int64 or uint64; every other number or flag becomes a float64.
    """
    packed: Records = np.zeros(1, dtype=_layout(component))
    packed[0] = _values(component)
    return packed


def _layout(component: Any) -> np.dtype[np.void]:
    return np.dtype([(name, _leaf_type(value)) for name, value in _items(component)])


def _leaf_type(value: Any) -> Any:
    if is_dataclass(value):
        return _layout(value)
    return value.dtype if isinstance(value, np.integer) else np.float64


def _values(component: Any) -> tuple[Any, ...]:
    return tuple(_values(value) if is_dataclass(value) else value for _, value in _items(component))


def _items(component: Any) -> list[tuple[str, Any]]:
    return [(item.name, getattr(component, item.name)) for item in fields(component)]
