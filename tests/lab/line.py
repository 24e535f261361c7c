"""A line of a benchmark's table: what, what is asked, what was measured."""

from collections.abc import Sequence
from typing import NamedTuple


class Line(NamedTuple):
    """One figure."""

    what: str
    asked: str
    measured: str
    met: bool


def print_table(lines: Sequence[Line]) -> None:
    """Print figures beneath each other; one that was not reached says so."""
    width = max(len(line.what) for line in lines)
    print(f"{'what':{width}} | {'asked':>14} | measured")
    for line in lines:
        print(f"{line.what:{width}} | {line.asked:>14} | {line.measured}{'' if line.met else '   NOT MET'}")
