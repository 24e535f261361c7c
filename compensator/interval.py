"""A value with the interval that holds the truth in 95 of 100 calibrations."""

from math import nan
from typing import NamedTuple

CONFIDENCE = 0.95


class Interval(NamedTuple):
    """One identified parameter.

    Attributes:
        value, low, high: in the parameter's unit; low and high are NaN where the data do not determine it.
        note: "" or why the value is to be read with care.
    """

    value: float
    low: float = nan
    high: float = nan
    note: str = ""
