"""Whether what is stated holds: how often luck looks as good as p says, and how often a name is right at each d'."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from bench.blind.judge import Result

STATED_P = (0.01, 0.05, 0.1, 0.2, 0.5)
EDGES = (0.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, float("inf"))


@dataclass(frozen=True, slots=True)
class Stated:
    """What is stated, and what was observed.

    Attributes:
        what: is stated.
        items: that it was observed on.
        observed: share of them.
    """

    what: str
    items: int
    observed: float


def p_values(results: Sequence[Result]) -> list[Stated]:
    """Complete models with a p-value of at most so much: that share of them, if it is honest."""
    found = [one.answer.p_value for one in results if one.family == "complete" and one.answer is not None]
    return [Stated(f"p <= {p:g}", len(found), _share([value <= p for value in found])) for p in STATED_P]


def names_by_detectability(results: Sequence[Result]) -> list[Stated]:
    """How often the first name is right, by the d' that the oracle gives the one effect that is hidden."""
    known = [
        (one.standings[0].detectability, bool(one.answer.first) and one.answer.first[0] == one.names[0])
        for one in results
        if one.family == "single" and one.answer is not None and one.standings[0] is not None
    ]
    rows = []
    for low, high in pairwise(EDGES):
        inside = [right for d_prime, right in known if low <= d_prime < high]
        words = f"d' {low:g} .. {high:g}" if high < EDGES[-1] else f"d' >= {low:g}"
        rows.append(Stated(words, len(inside), _share(inside)))
    return rows


def _share(values: Sequence[bool]) -> float:
    return sum(values) / len(values) if values else float("nan")
