"""Whether what is stated holds: how often luck looks as good as p says, and how often a name is right at each d'."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from scipy.stats import beta

from bench.blind.judge import Result

STATED_P = (0.01, 0.05, 0.1, 0.2, 0.5)
EDGES = (0.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, float("inf"))


@dataclass(frozen=True, slots=True)
class Stated:
    """What is stated, and what was observed.

    Attributes:
        what: is stated.
        at: the number that is stated; of a range, its lower end.
        items: that it was observed on.
        observed: share of them; low, high: its 95 % interval.
    """

    what: str
    at: float
    items: int
    observed: float
    low: float
    high: float


def p_values(results: Sequence[Result]) -> list[Stated]:
    """Complete models with a p-value of at most so much: that share of them, if it is honest."""
    found = [one.answer.p_value for one in results if one.family == "complete" and one.answer is not None]
    return [_stated(f"p <= {p:g}", p, [value <= p for value in found]) for p in STATED_P]


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
        rows.append(_stated(words, low, inside))
    return rows


def interval(hits: int, count: int) -> tuple[float, float]:
    """The 95 % interval of a share (Clopper and Pearson 1934)."""
    low = float(beta.ppf(0.025, hits, count - hits + 1)) if hits else 0.0
    high = float(beta.ppf(0.975, hits + 1, count - hits)) if hits < count else 1.0
    return low, high


def _stated(what: str, at: float, held: Sequence[bool]) -> Stated:
    if not held:
        return Stated(what, at, 0, float("nan"), float("nan"), float("nan"))
    return Stated(what, at, len(held), sum(held) / len(held), *interval(sum(held), len(held)))
