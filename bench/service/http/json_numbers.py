"""Numbers for JSON, which has no NaN: an absent quantity is null."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


def column(values: NDArray[np.float64]) -> list[float | None]:
    """A column as JSON numbers; NaN and infinities become None."""
    listed: list[float | None] = values.tolist()
    for index in np.flatnonzero(~np.isfinite(values)).tolist():
        listed[index] = None
    return listed


def plain(value: Any) -> Any:
    """Anything JSON-able with NaN and infinities as None, also inside dicts and lists, numpy numbers as Python's."""
    if isinstance(value, dict):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
