"""Draws the plant of a challenge: beside the drive factory, the only file that knows the simulation.

The factory makes the drive of a configuration; this makes what a configuration holds, and the answer to it.
"""

from dataclasses import dataclass

from sim_backend.challenge.draw import DrawnPlant, Wanted, draw_hidden, draw_plant, hide
from sim_backend.challenge.mechanisms import MECHANISMS
from sim_backend.challenge.ranges import DATA_SHEET, GEAR_SHEET, JOINT, Range

__all__ = ["MECHANISMS", "DrawnPlant", "Wanted", "draw_hidden", "draw_plant", "hide", "range_tables"]


@dataclass(frozen=True, slots=True)
class RangeTable:
    """A table of ranges, to be shown."""

    title: str
    rows: list[tuple[str, float, float, str, str]]


def range_tables() -> list[RangeTable]:
    """Every quantity that is drawn: name, ends, unit, and why."""
    sizes: dict[str, Range] = {f"{one.name}: {one.measure}": one.size for one in MECHANISMS.values()}
    return [
        RangeTable("The joint", _rows(JOINT)),
        RangeTable("What the data sheet may be off by, as a share of the true value", _rows(DATA_SHEET | GEAR_SHEET)),
        RangeTable("What may be hidden, and how much of it", _rows(sizes)),
    ]


def _rows(ranges: dict[str, Range]) -> list[tuple[str, float, float, str, str]]:
    return [(name, one.low, one.high, one.unit, one.reason) for name, one in ranges.items()]
