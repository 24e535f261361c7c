"""Cells of a report's tables."""

from math import isfinite

NO_SHARE = 1e-7  # less is rounding
SMALL_SHARE = 5e-4  # two digits after the point would say next to nothing of it


def number(value: float | None) -> float | None:
    """NaN as None."""
    return None if value is None or not isfinite(value) else value


def percent(share: float | None) -> str:
    """A share as per cent; a small one by its first two digits."""
    if share is None or not isfinite(share):
        return "-"
    return f"{100 * share:.2g}%" if NO_SHARE < abs(share) < SMALL_SHARE else f"{share:.2%}"


def cell(value: object) -> str:
    """A value of any kind, short."""
    if isinstance(value, list | tuple):
        return " ".join(map(cell, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
