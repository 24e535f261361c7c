"""Whether stated probabilities hold: p on complete models, right names by d', and measured d' by predicted d'."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np

from bench.evaluation.blind.result import Result
from bench.evaluation.figures.coverage import Share

Value = TypeVar("Value")
STATED_P = (0.01, 0.05, 0.1, 0.2, 0.5)
PREDICTED = (0.0, 3.0, 6.0, 9.0, 12.0, 18.0, 27.0, float("inf"))  # ranges of d' that are predicted
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


@dataclass(frozen=True, slots=True)
class Came:
    """What d' came of the trials that were suggested, where one was predicted.

    Attributes:
        what: is predicted; at: the median of it.
        rounds: that it was observed in.
        median: of the d' that came; low, high: its quartiles. NaN without a round, as `at`.
    """

    what: str
    at: float
    rounds: int
    median: float
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
    return [_stated(words, low, held) for words, low, held in _by_d_prime(known)]


def named_by_prediction(results: Sequence[Result]) -> list[Stated]:
    """How often the truth is named alone after suggested trials, by the d' that was predicted of six of them.

    The first row is of those that the lab did not have among the rivals before, so that it predicted nothing of them.
    """
    known = [(one.settled.predicted, one.settled.named == one.names) for one in results if one.settled is not None]
    rows = _by_d_prime([(predicted, right) for predicted, right in known if predicted > 0.0])
    unforeseen = [right for predicted, right in known if predicted == 0.0]
    return [_stated("no rival before", 0.0, unforeseen), *(_stated(words, low, held) for words, low, held in rows)]


def came_of_prediction(results: Sequence[Result]) -> list[Came]:
    """The measured d' of the truth after each round of suggested trials, by the predicted d'."""
    rounds = [pair for one in results if one.settled is not None for pair in one.settled.stated if min(pair) > 0.0]
    rows = []
    for words, _, held in _by_d_prime([(pair[0], pair) for pair in rounds], PREDICTED):
        quartiles = np.quantile(held, [0.25, 0.5, 0.75], axis=0) if held else np.full((3, 2), np.nan)
        low, median, high = (float(one) for one in quartiles[:, 1])
        rows.append(Came(words, float(quartiles[1, 0]), len(held), median, low, high))
    return rows


def _by_d_prime(
    known: Sequence[tuple[float, Value]], edges: Sequence[float] = EDGES
) -> list[tuple[str, float, list[Value]]]:
    """What belongs to each range of d': its words, its lower end, the values."""
    rows = []
    for low, high in pairwise(edges):
        inside = [value for d_prime, value in known if low <= d_prime < high]
        rows.append((f"d' {low:g} .. {high:g}" if high < edges[-1] else f"d' >= {low:g}", low, inside))
    return rows


def _stated(what: str, at: float, held: Sequence[bool]) -> Stated:
    if not held:
        return Stated(what, at, 0, float("nan"), float("nan"), float("nan"))
    return Stated(what, at, len(held), sum(held) / len(held), *Share(sum(held), len(held)).interval())
