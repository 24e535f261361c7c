"""The figures of a run: what is asked of the lab, and what was measured."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isnan, nan

import numpy as np
from scipy.stats import kstest

from bench.evaluation.blind.result import LabAnswer, Result, Standing
from bench.evaluation.blind.smallest import smallest_found
from bench.evaluation.challenge.names import ACCEPTED
from bench.evaluation.figures.coverage import Share

MUST_NAME, MUST_NOT_NAME = 6.0, 3.0  # d' from which a name is due, and below which a single one is too much
STATED, OFF = 0.9, 0.04  # confidence of intervals, and by how much it may be wrong
SHOWN = 0.15  # r from which an effect is expected in the class
CLEAR = 0.3


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the table.

    Attributes:
        what: is measured.
        asked: in words.
        measured: a share, a ratio or a size; NaN where no item tells.
        low, high: its 95 % interval, NaN where none is known.
        items: it was measured on.
        reached: whether it is what was asked.
        is_share: of items; otherwise a number.
    """

    what: str
    asked: str
    measured: float
    low: float
    high: float
    items: int
    reached: bool
    is_share: bool = True

    @property
    def is_told(self) -> bool:
        """Whether any item tells it: what was not asked is neither reached nor missed."""
        return not isnan(self.measured)


def figures(results: Sequence[Result]) -> list[Figure]:
    """Every figure, from the results of a run."""
    answered = [one for one in results if one.answer is not None]
    singles = [one for one in answered if one.family == "single" and one.standings[0] is not None]
    strong = [one for one in singles if _standing(one).detectability >= MUST_NAME]
    right = [one for one in strong if _is_right(one)]
    whole = [one for one in right if not one.laws]  # beside other laws of friction a flag is right
    weak = [one for one in singles if _standing(one).detectability < MUST_NOT_NAME]
    shown = [one for one in singles if _standing(one).ratio >= SHOWN]
    findable = [one for one in shown if _standing(one).ratio >= _standing(one).smallest]
    ranked = [one for one in shown if _answer(one).ranked is not None]
    pairs = [one for one in answered if one.family == "pair" and _both_clear(one)]
    exact = [one for one in pairs if _is_exact(one)]
    memory = [one for one in answered if one.family == "memory"]
    settled = [one for one in answered if one.settled is not None and one.settled.predicted >= MUST_NAME]
    promised = [one for one in settled if one.settled is not None and one.settled.promised >= MUST_NAME]
    return [
        *_false_alarms(answered),
        _uniform(answered),
        _intervals(answered),
        _named_by_other_laws(answered),
        *_wrong_names(answered),
        _share("named first where d' >= 6", 0.95, strong, _is_right),
        _share("truth among the first three, r >= 0.15", 0.98, ranked, _among_three),
        _share("truth in the class, r >= 0.15", 0.97, shown, _in_class),
        _share("the same, where theory finds it nine times in ten", 0.97, findable, _in_class),
        _class_size([one for one in shown if _in_class(one)]),
        _share("a single name where d' < 3", 0.1, weak, lambda one: len(_first(one)) == 1, at_most=True),
        _smallest_found(singles),
        *_held_out(right),
        _share("two effects of r >= 0.3, both and no other", 0.85, pairs, _is_exact),
        _share("the same, where d' >= 6 for each of them", 0.85, [one for one in pairs if _both_sure(one)], _is_exact),
        _mean("two effects of r >= 0.3, recall", "at least 95 %", [_recall(one) for one in pairs], 0.95),
        *_outside(answered),
        *_withheld(singles),
        _share("false flags of something outside, where the truth was named", 0.05, whole, _flagged, at_most=True),
        _share("the same, where two were named and no other", 0.05, exact, _flagged, at_most=True),
        _share("memory effects named first", 0.9, memory, _is_right),
        _share("the same, where d' >= 6", 0.9, [one for one in memory if _must_be_named(one)], _is_right),
        _share("named alone after at most six suggested trials, predicted d' >= 6", 0.9, settled, _is_settled),
        _share("the same, where the lab promises d' >= 6", 0.9, promised, _is_settled),
        _gain_over_chance(answered),
    ]


def _gain_over_chance(answered: Sequence[Result]) -> Figure:
    """Predicted d'^2 of the rivals with the suggested trials, over that with as many drawn from the same options."""
    known = [one.settled for one in answered if one.settled is not None and one.settled.by_chance > 0.0]
    ratios = [(one.predicted / one.by_chance) ** 2 for one in known]
    mean = float(np.exp(np.mean(np.log(ratios)))) if ratios else nan
    what = "d'^2 with suggested trials over that with random ones, geometric mean"
    return Figure(what, "at least 1.7", mean, nan, nan, len(ratios), mean >= 1.7)


def _false_alarms(answered: Sequence[Result]) -> list[Figure]:
    families = {"complete": 0.02, "imperfect": 0.05, "at-rest": 0.02}
    words = {
        "complete": "false alarms, complete models (a name or a flag)",
        "imperfect": "the same, with delay, jitter, lost rows",
        "at-rest": "the same as the first, with starts from rest and reversals recorded",
    }

    def alarm(one: Result) -> bool:
        return _answer(one).verdict != "nothing" or _answer(one).unknown

    return [
        _share(words[name], asked, [one for one in answered if one.family == name], alarm, at_most=True)
        for name, asked in families.items()
    ]


def _uniform(answered: Sequence[Result]) -> Figure:
    """Of complete models every p-value is as likely as every other (Kolmogorov, Smirnov)."""
    found = [_answer(one).p_value for one in answered if one.family == "complete"]
    chance = float(kstest(found, "uniform").pvalue) if found else nan
    what = "chance of such p-values of complete models, if they are uniform"
    return Figure(what, "at least 5 %", chance, nan, nan, len(found), chance >= 0.05)


def _intervals(answered: Sequence[Result]) -> Figure:
    """Intervals of the parameters of complete models hold the truth as often as they say."""
    held = [one <= STATED for result in answered for one in result.confidences]
    count, share = len(held), float(np.mean(held)) if held else nan
    low, high = Share(sum(held), count).interval()
    asked = f"{STATED - OFF:.0%} .. {STATED + OFF:.0%}"
    what = f"{STATED:.0%} intervals of the parameters of complete models that hold the truth"
    return Figure(what, asked, share, low, high, count, abs(share - STATED) <= OFF)


def _named_by_other_laws(answered: Sequence[Result]) -> Figure:
    """Friction by laws that the base model does not have may be flagged; a name that none of them has is wrong."""
    what = "wrongly named though nothing is hidden, friction by laws outside the base model"
    among = [one for one in answered if one.family == "other-laws"]
    return _share(what, 0.02, among, _is_wrong, at_most=True)


def _wrong_names(answered: Sequence[Result]) -> list[Figure]:
    """Whatever is hidden: names are given where the held-out gain is surely above zero, and nowhere else."""
    named = [one for one in answered if _first(one)]

    def wrong(one: Result) -> bool:
        return not _right_names(one).intersection(_first(one))

    alone = [one for one in named if not _flagged(one)]
    return [
        _share("wrong names, of those with a held-out gain surely above zero", 0.03, named, wrong, at_most=True),
        _share("the same, where nothing else is said to be left", 0.03, alone, wrong, at_most=True),
    ]


def _outside(answered: Sequence[Result]) -> list[Figure]:
    """Mechanisms outside the catalogue."""
    outside = [one for one in answered if one.names == ("",) and one.unexplained is not None]
    middle = [one for one in outside if 0.3 <= _unexplained_ratio(one) < 0.6]
    large = [one for one in outside if _unexplained_ratio(one) >= 0.6]
    return [
        _share("outside the catalogue, flagged, r 0.3 .. 0.6", 0.8, middle, _flagged),
        _share("outside the catalogue, flagged, r >= 0.6", 0.95, large, _flagged),
    ]


def _withheld(singles: Sequence[Result]) -> list[Figure]:
    """Effects withheld from the catalogue: the lab may name another, but has to say that more is missing."""
    asked = [one for one in singles if one.withheld is not None]

    def says_so(one: Result) -> bool:
        assert one.withheld is not None
        return one.withheld.unknown

    middle = [one for one in asked if 0.3 <= _standing(one).ratio < 0.6]
    large = [one for one in asked if _standing(one).ratio >= 0.6]
    same = "the same, where theory finds what is left beside the name nine times in ten"
    return [
        _share("withheld from the catalogue, flagged, r 0.3 .. 0.6", 0.8, middle, says_so),
        _share(same, 0.8, [one for one in middle if _can_be_flagged(one)], says_so),
        _share("withheld from the catalogue, flagged, r >= 0.6", 0.95, large, says_so),
        _share(same, 0.95, [one for one in large if _can_be_flagged(one)], says_so),
    ]


def _can_be_flagged(one: Result) -> bool:
    """Whether the withheld effect leaves enough, beside the name given in its place, for theory to find it."""
    left = one.withheld_left
    return left is not None and left.ratio >= left.smallest


def _unexplained_ratio(one: Result) -> float:
    """The r of a mechanism outside the catalogue, from the growth of the base model's residual."""
    return ratio_of(one.unexplained or 1.0)


def _held_out(right: Sequence[Result]) -> list[Figure]:
    ratios = [_answer(one).error / one.oracle_error for one in right]
    worst = float(np.quantile(ratios, 0.95)) if ratios else nan
    return [
        _mean("held-out error over the oracle's, mean", "at most 1.01", ratios, 1.01, at_most=True),
        Figure("the same, 95 % quantile", "at most 1.03", worst, nan, nan, len(ratios), worst <= 1.03),
    ]


def _class_size(named: Sequence[Result]) -> Figure:
    return _mean("mean size of that class", "at most 2.0", [len(_first(one)) for one in named], 2.0, at_most=True)


def _smallest_found(singles: Sequence[Result]) -> Figure:
    """The r from which one is found, over what theory needs."""
    found = [_answer(one).verdict != "nothing" for one in singles]
    ratios = [max(_standing(one).ratio, 1e-6) / _standing(one).smallest for one in singles]
    ratio, low, high = smallest_found(ratios, found)
    what = "smallest effect found 9 times in 10, over the bound"
    return Figure(what, "at most 1.3", ratio, low, high, len(singles), ratio <= 1.3, is_share=False)


def _share(
    what: str, limit: float, among: Sequence[Result], holds: Callable[[Result], bool], at_most: bool = False
) -> Figure:
    asked = f"{'at most' if at_most else 'at least'} {limit:.0%}"
    count, hits = len(among), sum(holds(one) for one in among)
    if not count:
        return Figure(what, asked, nan, nan, nan, 0, False)
    low, high = Share(hits, count).interval()
    measured = hits / count
    return Figure(what, asked, measured, low, high, count, measured <= limit if at_most else measured >= limit)


def _mean(what: str, asked: str, values: Sequence[float], limit: float, at_most: bool = False) -> Figure:
    measured = float(np.mean(values)) if values else nan
    reached = measured <= limit if at_most else measured >= limit
    return Figure(what, asked, measured, nan, nan, len(values), reached)


def _answer(one: Result) -> LabAnswer:
    assert one.answer is not None
    return one.answer


def _standing(one: Result) -> Standing:
    standing = one.standings[0]
    assert standing is not None
    return standing


def _first(one: Result) -> tuple[str, ...]:
    return _answer(one).first


def _must_be_named(one: Result) -> bool:
    return one.standings[0] is not None and one.standings[0].detectability >= MUST_NAME


def _is_right(one: Result) -> bool:
    return _first(one)[:1] == one.names[:1] or _named_beside_laws(one)


def _is_wrong(one: Result) -> bool:
    return bool(_first(one)) and _first(one)[0] not in one.own


def _in_class(one: Result) -> bool:
    return one.names[0] in _first(one) or _named_beside_laws(one)


def _named_beside_laws(one: Result) -> bool:
    """Whether the first name is that of a law of the joint's own friction, and what is hidden is named after it."""
    first = _first(one)[:1]
    return bool(first) and first[0] in one.own and one.names[:1] in [names[:1] for names in _answer(one).named]


def _among_three(one: Result) -> bool:
    return one.names[0] in (*_first(one)[:1], *(_answer(one).ranked or ()))


def _flagged(one: Result) -> bool:
    return _answer(one).unknown


def _is_settled(one: Result) -> bool:
    return one.settled is not None and one.settled.named == one.names


def _both_clear(one: Result) -> bool:
    return all(standing is not None and standing.ratio >= CLEAR for standing in one.standings)


def _both_sure(one: Result) -> bool:
    return all(standing is not None and standing.detectability >= MUST_NAME for standing in one.standings)


def _recall(one: Result) -> float:
    named = {names[0] for names in _answer(one).named}
    return sum(name in named for name in one.names) / len(one.names)


def _is_exact(one: Result) -> bool:
    return _recall(one) == 1.0 and not _extra(one)


def _extra(one: Result) -> bool:
    """Whether something is named that is no right name of anything that is hidden."""
    return any(names[0] not in _right_names(one) for names in _answer(one).named)


def _right_names(one: Result) -> set[str]:
    """Of all that is hidden, and of its own laws of friction."""
    accepted = {name for truth in one.truths for name in ACCEPTED.get(truth, ())}
    return {*one.names, *one.own, *accepted}


def ratio_of(left: float) -> float:
    """The r of what no effect stands for, from what the base model leaves with it over that without."""
    return float(np.sqrt(max(left**2 - 1.0, 0.0)))
