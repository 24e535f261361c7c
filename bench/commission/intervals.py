"""Intervals as the results of experiments hold them."""

from bench.json_types import Value, Values, number
from compensator.line_fit import Interval


def interval(results: Values, name: str) -> Interval:
    """[value, low, high, note] as an interval; NaN for what is not known.

    Raises:
        TypeError: the result is no such list.
    """
    found = results[name]
    if isinstance(found, str) or not isinstance(found, list | tuple):
        raise TypeError(f"{name} is {found!r}; [value, low, high, note] is wanted")
    value, low, high, note = found
    return Interval(_number(value), _number(low), _number(high), str(note))


def _number(value: Value) -> float:
    return float("nan") if value is None else number(value)
