"""Confusion table: the effect that was hidden, and the names that the lab and the rival methods gave."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from bench.evaluation.blind.baseline_methods import RIVALS
from bench.evaluation.blind.figures import MUST_NAME
from bench.evaluation.blind.result import Result

NOTHING, UNKNOWN, REFUSED = "nothing", "none of these", "refused"


@dataclass(frozen=True, slots=True)
class Confusion:
    """One mechanism, in the families where it is hidden alone, and complete models as "nothing".

    Attributes:
        truth: the mechanism; name: of its effect, "" where the catalogue has none.
        items: how many; due: how many of them stand out by d' >= 6.
        right_of_due: of those, named first.
        answers: what was answered first, most frequent first.
    """

    truth: str
    name: str
    items: int
    due: int
    right_of_due: int
    answers: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class RivalFigures:
    """What a rival makes of the same items: false alarms on complete models, named first where d' >= 6."""

    name: str
    false_alarm: float
    named_first: float


def confusions(results: Sequence[Result]) -> list[Confusion]:
    """One row for each mechanism, the most confused first."""
    groups: dict[tuple[str, str], list[Result]] = {}
    for one in results:
        if len(one.truths) <= 1:
            truth = one.truths[0] if one.truths else f"nothing ({one.family})"
            groups.setdefault((truth, one.names[0] if one.names else NOTHING), []).append(one)
    rows = [_row(truth, name, group) for (truth, name), group in groups.items()]
    return sorted(rows, key=lambda row: (row.right_of_due - row.due, row.truth))


def answer_of(one: Result) -> str:
    """What the lab answers first, in one word."""
    if one.answer is None:
        return REFUSED
    if one.answer.verdict == "unknown-effect":
        return UNKNOWN
    return one.answer.first[0] if one.answer.first else NOTHING


def rival_figures(results: Sequence[Result]) -> list[RivalFigures]:
    """The lab and its rivals on the same items."""
    answered = [one for one in results if one.answer is not None]
    complete = [one for one in answered if one.family == "complete"]
    due = [one for one in answered if one.family == "single" and _due(one)]

    def line(name: str, first: dict[str, str]) -> RivalFigures:
        alarms = [first[one.key] != NOTHING for one in complete]
        right = [first[one.key] == one.names[0] for one in due]
        return RivalFigures(name, _mean(alarms), _mean(right))

    ours = line("this lab", {one.key: answer_of(one) for one in answered})
    theirs = [
        line(rival, {one.key: next(iter(one.rivals.get(rival, ())), NOTHING) for one in answered}) for rival in RIVALS
    ]
    return [ours, *theirs]


def _row(truth: str, name: str, group: list[Result]) -> Confusion:
    due = [one for one in group if _due(one)]
    right = sum(answer_of(one) == name for one in due)
    answers = Counter(answer_of(one) for one in group).most_common()
    return Confusion(truth, name, len(group), len(due), right, tuple(answers))


def _due(one: Result) -> bool:
    standing = one.standings[0] if len(one.standings) == 1 else None
    return standing is not None and standing.detectability >= MUST_NAME


def _mean(values: Sequence[bool]) -> float:
    return sum(values) / len(values) if values else float("nan")
