import json
from dataclasses import replace
from math import isnan

import numpy as np
import pytest

from bench.evaluation.blind.calibration import (
    came_of_prediction,
    named_by_prediction,
    names_by_detectability,
    p_values,
)
from bench.evaluation.blind.confusion import confusions, rival_figures
from bench.evaluation.blind.figures import Figure, figures
from bench.evaluation.blind.result import LabAnswer, Result, Settled, Standing
from bench.evaluation.blind.smallest import smallest_found


def _result(
    family: str, name: str, first: tuple[str, ...], ratio: float, d_prime: float, key: str = "", unknown: bool = False,
    unexplained: float | None = None,
) -> Result:  # fmt: skip
    verdict = "missing" if first else "unknown-effect" if unknown else "nothing"
    answer = LabAnswer(verdict, first, (first,) if first else (), unknown, 0.001, 9.0, 0.021)
    known = Standing(ratio, d_prime, "spring", 0.1) if name else None
    truths = () if family == "complete" else (name or "hose",)
    return Result(
        key, family, truths, (name,) if truths else (), (1.0,) * len(truths), answer, (known,) * len(truths),
        unexplained, 0.02, {"stepwise BIC": ("drag",)},
    )  # fmt: skip


def _figure(results: list[Result], what: str) -> Figure:
    return next(one for one in figures(results) if what in one.what)


def test_what_must_be_named_and_what_must_not() -> None:
    results = [
        _result("single", "spring", ("spring",), 1.0, 9.0),
        _result("single", "spring", ("viscous_asymmetry", "spring"), 1.0, 7.0),
        _result("single", "spring", (), 0.2, 6.5),
        _result("single", "spring", ("viscous_asymmetry",), 0.05, 1.0),
        _result("single", "spring", ("spring", "offset"), 0.05, 2.9),
        _result("single", "spring", ("spring",), 0.05, 4.0),
    ]
    named = _figure(results, "named first where")
    assert (named.items, named.measured) == (3, pytest.approx(1 / 3))
    assert not named.reached
    in_class = _figure(results, "truth in the class")
    assert (in_class.items, in_class.measured) == (3, pytest.approx(2 / 3))
    assert _figure(results, "where theory finds it").items == 3
    assert _figure(results, "mean size").measured == pytest.approx(1.5)
    single = _figure(results, "a single name")
    assert (single.items, single.measured) == (2, 0.5)
    assert _figure(results, "over the oracle's, mean").measured == pytest.approx(1.05)


def _complete_with(p_value: float) -> Result:
    one = _result("complete", "", (), 0.0, 0.0)
    assert one.answer is not None
    return replace(one, answer=replace(one.answer, p_value=p_value))


def test_p_values_of_complete_models_are_held_against_a_uniform_distribution() -> None:
    even = (np.arange(200) + 0.5) / 200.0
    honest = _figure([_complete_with(p) for p in even], "if they are uniform")
    cautious = _figure([_complete_with(min(1.0, 5.0 * p)) for p in even], "if they are uniform")
    assert honest.reached
    assert honest.items == 200
    assert not cautious.reached


@pytest.mark.parametrize(
    ("first", "named", "own", "right"),
    [
        ("pre_sliding", ("pre_sliding", "spring"), ("pre_sliding",), 1.0),
        ("pre_sliding", ("pre_sliding",), ("pre_sliding",), 0.0),  # what is hidden is not named
        ("pre_sliding", ("pre_sliding", "spring"), (), 0.0),  # of no law that the joint has
        ("spring", ("spring",), ("pre_sliding",), 1.0),
    ],
)
def test_a_name_of_the_joints_own_friction_is_right_where_what_is_hidden_follows(first, named, own, right) -> None:
    one = _result("single", "spring", (first,), 1.0, 9.0)
    assert one.answer is not None
    searched = replace(one.answer, named=tuple((name,) for name in named))
    found = [replace(one, answer=searched, own=own)]
    assert _figure(found, "named first where").measured == right
    assert _figure(found, "truth in the class").measured == right


def test_of_other_laws_a_name_that_none_of_them_has_is_wrong() -> None:
    joint = _result("other-laws", "", ("viscous_power",), 0.0, 0.0)
    results = [replace(joint, own=own) for own in (("viscous_power",), ("pre_sliding",), ())]
    assert _figure(results, "wrongly named though nothing is hidden").measured == pytest.approx(2 / 3)


def test_a_name_is_wrong_where_neither_what_is_hidden_nor_a_law_of_the_joint_is_in_its_class() -> None:
    flagged = _result("outside", "", ("cogging",), 0.0, 0.0, unknown=True)
    results = [
        _result("single", "spring", ("cogging", "spring"), 1.0, 9.0),
        _result("single", "spring", ("cogging",), 1.0, 9.0),
        _result("single", "spring", (), 1.0, 9.0),
        replace(_result("other-laws", "", ("viscous_power",), 0.0, 0.0), own=("viscous_power",)),
        flagged,
    ]
    found = _figure(results, "wrong names, of those")
    assert (found.items, found.measured) == (4, 0.5)
    alone = next(one for one in figures(results) if one.what == "the same, where nothing else is said to be left")
    assert (alone.items, alone.measured) == (3, pytest.approx(1 / 3))


def test_a_flag_beside_other_laws_of_friction_is_right() -> None:
    flagged = _result("single", "spring", ("spring",), 1.0, 9.0, unknown=True)
    results = [flagged, replace(flagged, laws=0.05), replace(flagged, laws=0.2)]
    assert _figure(results, "false flags of something outside").items == 1


def test_of_memory_what_theory_can_name_has_a_line_of_its_own() -> None:
    results = [
        _result("memory", "backlash", ("backlash",), 1.0, 9.0),
        _result("memory", "backlash", (), 1.0, 6.0),
        _result("memory", "dwell_strengthening", (), 1.0, 5.9),
    ]
    found = [one for one in figures(results) if "memory" in one.what or one.what == "the same, where d' >= 6"]
    assert [(one.items, one.measured) for one in found] == [(3, pytest.approx(1 / 3)), (2, 0.5)]


def test_what_was_withheld_has_to_be_flagged_whatever_is_named_instead() -> None:
    def asked(ratio: float, withheld: LabAnswer | None) -> Result:
        return replace(_result("single", "spring", ("spring",), ratio, 9.0), withheld=withheld)

    wrong_and_flagged = LabAnswer("missing", ("cogging",), (("cogging",),), True, 0.001, 9.0, 0.03)
    wrong = replace(wrong_and_flagged, unknown=False)
    results = [
        asked(0.4, wrong_and_flagged),
        asked(0.4, wrong),
        asked(0.9, wrong_and_flagged),
        asked(0.1, wrong),  # too little to be asked for
        asked(0.9, None),  # of a run by an older version
    ]
    middle, large = (
        _figure(results, "withheld from the catalogue, flagged, r 0.3"),
        _figure(results, "flagged, r >= 0.6"),
    )
    assert (middle.items, middle.measured) == (2, 0.5)
    assert _figure(results, "withheld from the catalogue, flagged, r >= 0.6").items == 1
    assert large.items == 0  # of nothing that the catalogue does not have
    assert Result.from_json(json.loads(json.dumps(results[0].to_json()))) == results[0]


def test_of_what_was_withheld_only_what_the_name_in_its_place_leaves_can_be_flagged() -> None:
    flagged, passed_over = (LabAnswer("nothing", (), (), unknown, 0.5, 0.0, 0.02) for unknown in (True, False))

    def asked(ratio: float, withheld: LabAnswer, left: float | None) -> Result:
        beside = None if left is None else Standing(left, 1.0, "cogging", 0.2)
        one = _result("single", "spring", ("spring",), ratio, 9.0)
        return replace(one, withheld=withheld, withheld_left=beside)

    results = [
        asked(0.8, flagged, 0.5),
        asked(0.8, passed_over, 0.1),
        asked(0.8, passed_over, None),
        asked(0.4, passed_over, 0.3),
    ]
    middle, large = [one for one in figures(results) if "left beside the name" in one.what]
    assert (large.items, large.measured) == (1, pytest.approx(1.0))
    assert (middle.items, middle.measured) == (1, pytest.approx(0.0))
    assert Result.from_json(json.loads(json.dumps(results[0].to_json()))) == results[0]


def test_what_theory_cannot_find_in_so_few_rows_is_counted_apart() -> None:
    hard = replace(_result("single", "spring", (), 0.2, 2.0), standings=(Standing(0.2, 2.0, "cogging", 0.25),))
    results = [_result("single", "spring", ("spring",), 0.3, 9.0), hard]
    assert _figure(results, "truth in the class").measured == 0.5
    findable = _figure(results, "where theory finds it")
    assert (findable.items, findable.measured) == (1, 1.0)


def test_false_alarms_come_with_the_interval_of_a_share() -> None:
    results = [_result("complete", "", ("spring",) if n == 0 else (), 0.0, 0.0) for n in range(100)]
    alarms = _figure(results, "false alarms, complete")
    assert alarms.measured == 0.01
    assert (alarms.low, alarms.high) == (pytest.approx(0.00025, rel=0.02), pytest.approx(0.0545, rel=0.01))
    assert alarms.reached
    assert isnan(_figure(results, "the same, with delay").measured)


def test_outside_is_sorted_by_what_it_leaves_unexplained() -> None:
    results = [
        _result("outside", "", (), 0.0, 0.0, unknown=True, unexplained=1.1),  # r = 0.46
        _result("outside", "", ("spring",), 0.0, 0.0, unexplained=1.1),
        _result("outside", "", (), 0.0, 0.0, unknown=True, unexplained=3.0),
        _result("outside", "", (), 0.0, 0.0, unexplained=1.01),  # r = 0.14: too little to be asked for
    ]
    middle, large = _figure(results, "flagged, r 0.3"), _figure(results, "flagged, r >= 0.6")
    assert (middle.items, middle.measured) == (2, 0.5)
    assert (large.items, large.measured) == (1, 1.0)


def test_of_pairs_those_that_are_clear_are_asked_for_and_flags_where_both_are_right() -> None:
    def pair(named: tuple[str, ...], ratio: float = 0.5, unknown: bool = False, d_prime: float = 9.0) -> Result:
        one = _result("pair", "spring", ("spring",), ratio, d_prime)
        answer = LabAnswer("missing", named[:1], tuple((name,) for name in named), unknown, 0.001, 9.0, 0.021)
        return replace(
            one, answer=answer, truths=("spring", "drag"), names=("spring", "drag"), standings=one.standings * 2
        )

    results = [
        pair(("spring", "drag")),
        pair(("drag", "spring"), unknown=True),
        pair(("spring",), unknown=True, d_prime=5.0),  # not sure enough for both to be asked for
        pair(("spring", "drag", "cogging")),
        pair(("cogging",), ratio=0.2),  # too small to be asked for
    ]
    both, recall = _figure(results, "both and no other"), _figure(results, "recall")
    assert (both.items, both.measured) == (4, 0.5)
    assert (recall.items, recall.measured) == (4, pytest.approx(7 / 8))
    sure = _figure(results, "for each of them")
    assert (sure.items, sure.measured) == (3, pytest.approx(2 / 3))
    heavy = replace(
        pair(("weight_friction", "drag", "weight_stribeck")),
        truths=("weight_growth", "drag"),
        names=("weight_friction", "drag"),
    )
    assert _figure([heavy], "both and no other").measured == 1.0  # of one mechanism two shares are right
    flags = _figure(results, "where two were named")
    assert (flags.items, flags.measured, flags.reached) == (2, 0.5, False)


def test_smallest_effect_is_where_the_curve_of_detection_reaches_nine_in_ten() -> None:
    results = []
    for step in range(200):
        ratio = 0.02 * 1.02**step  # 0.02 .. 1
        results.append(_result("single", "spring", ("spring",) if ratio > 0.15 else (), ratio, 5.0))
    # theory needs 0.1 (see `_result`), and all above 0.15 are found
    smallest = _figure(results, "smallest effect")
    assert smallest.measured == pytest.approx(1.5, rel=0.05)
    assert 1.4 < smallest.low <= smallest.measured <= smallest.high < 1.6
    assert not smallest.is_share


def test_the_interval_of_the_smallest_effect_holds_the_truth_as_often_as_it_says() -> None:
    random = np.random.default_rng(7)
    held = 0
    for _ in range(40):
        sizes = np.exp(random.uniform(-2.5, 2.5, 100))
        chance = 1.0 / (1.0 + (1.2 / sizes) ** 3)  # nine in ten at 1.2 * 9^(1/3)
        _, low, high = smallest_found(sizes.tolist(), (random.uniform(size=100) < chance).tolist())
        held += low <= 1.2 * 9.0 ** (1.0 / 3.0) <= high
    assert held >= 33  # of 95 %, less luck, and less what so few items make of the guessed share


def test_of_few_items_or_of_those_that_are_all_found_no_smallest_effect_is_told() -> None:
    assert all(isnan(one) for one in smallest_found([1.0] * 30, [True] * 30))
    assert all(isnan(one) for one in smallest_found([0.1, 1.0] * 9, [False, True] * 9))


def test_confusion_by_effect_and_rivals_on_the_same_items() -> None:
    results = [
        _result("single", "spring", ("spring",), 1.0, 9.0, "a"),
        _result("single", "spring", ("gravity",), 1.0, 9.0, "b"),
        _result("single", "spring", (), 0.1, 2.0, "c"),
        _result("complete", "", (), 0.0, 0.0, "d"),
    ]
    worst = confusions(results)[0]
    assert (worst.truth, worst.items, worst.due, worst.right_of_due) == ("spring", 3, 2, 1)
    assert dict(worst.answers) == {"spring": 1, "gravity": 1, "nothing": 1}
    ours, *theirs = rival_figures(results)
    assert (ours.false_alarm, ours.named_first) == (0.0, 0.5)
    stepwise = next(one for one in theirs if one.name == "stepwise BIC")
    assert (stepwise.false_alarm, stepwise.named_first) == (1.0, 0.0)


def test_calibration_counts_what_was_stated() -> None:
    results = [
        _result("complete", "", (), 0.0, 0.0),  # its p is 0.001
        _result("single", "spring", ("spring",), 1.0, 4.5),
        _result("single", "spring", ("gravity",), 1.0, 4.0),
        _result("single", "spring", ("spring",), 1.0, 70.0),
    ]
    assert all((one.items, one.observed) == (1, 1.0) for one in p_values(results))
    by_d = {one.what: (one.items, one.observed) for one in names_by_detectability(results)}
    assert by_d["d' 4 .. 5"] == (2, 0.5)
    assert by_d["d' >= 7"] == (1, 1.0)
    assert by_d["d' 0 .. 2"][0] == 0


def test_the_first_three_are_those_of_the_ranking_and_the_name_given() -> None:
    third = replace(_result("single", "spring", (), 0.2, 6.5), answer=None)
    answer = LabAnswer("nothing", (), (), False, 0.2, 1.0, 0.02, ("gravity", "offset", "spring"))
    results = [
        replace(third, answer=answer),
        replace(third, answer=replace(answer, ranked=("gravity", "offset", "viscous_asymmetry"))),
        replace(third, answer=replace(answer, first=("spring",), ranked=())),
        replace(_result("single", "spring", (), 0.1, 6.5), answer=answer),  # too small to be asked for
        _result("single", "spring", ("spring",), 1.0, 9.0),  # an older result does not tell
    ]
    three = _figure(results, "among the first three")
    assert (three.items, three.measured) == (3, pytest.approx(2 / 3))


def test_suggested_trials_are_held_against_random_ones() -> None:
    one = _result("settle", "spring", ("spring",), 1.0, 9.0)
    settled = [
        Settled(("spring",), 1.0, predicted, 6, ("spring",), by_chance) for predicted, by_chance in ((4, 2), (3, 3))
    ]
    gain = _figure([*(replace(one, settled=found) for found in settled), one], "over that with random ones")
    assert (gain.items, gain.measured) == (2, pytest.approx(2.0))  # of 4 and 1
    assert gain.reached
    old = {"rivals": [], "before": 1.0, "predicted": 2.0, "trials": 6, "named": []}
    again = Result.from_json(one.to_json() | {"settled": old})
    assert again.settled is not None
    assert again.settled.by_chance == 0.0
    with pytest.raises(ValueError, match="colour"):
        Result.from_json(one.to_json() | {"colour": "blue"})


def test_a_promise_is_asked_to_be_kept() -> None:
    one = _result("settle", "spring", ("spring",), 1.0, 9.0)
    kept = Settled(("spring",), 1.0, 9.0, 6, ("spring",), promised=6.5)
    broken = replace(kept, named=(), promised=5.5)
    results = [replace(one, settled=settled) for settled in (kept, broken, broken)]
    assert _figure(results, "predicted d' >= 6").measured == pytest.approx(1 / 3)
    assert (_figure(results, "the lab promises").items, _figure(results, "the lab promises").measured) == (1, 1.0)
    assert Result.from_json(results[0].to_json()) == results[0]


def test_what_was_predicted_of_suggested_trials_is_held_against_what_came() -> None:
    one = _result("settle", "spring", ("spring",), 1.0, 9.0)

    def result(predicted: float, named: str, stated: tuple[tuple[float, float], ...]) -> Result:
        return replace(one, settled=Settled(("spring",), 1.0, predicted, 6, (named,), 0.5 * predicted, 0, stated))

    results = [
        result(6.5, "spring", ((5.0, 4.0), (7.0, 6.0))),
        result(6.5, "cogging", ((5.0, 8.0), (0.0, 3.0))),
        result(0.0, "spring", ((0.0, 0.0),)),
        one,
    ]
    again = [Result.from_json(json.loads(json.dumps(one.to_json()))) for one in results]
    assert again == results
    by_d_prime = {row.what: row for row in named_by_prediction(results)}
    assert (by_d_prime["no rival before"].items, by_d_prime["no rival before"].observed) == (1, 1.0)
    assert (by_d_prime["d' 6 .. 7"].items, by_d_prime["d' 6 .. 7"].observed) == (2, 0.5)
    came = {row.what: row for row in came_of_prediction(results)}
    assert (came["d' 3 .. 6"].rounds, came["d' 3 .. 6"].at, came["d' 3 .. 6"].median) == (2, 5.0, 6.0)
    assert (came["d' 3 .. 6"].low, came["d' 3 .. 6"].high) == (5.0, 7.0)
    assert (came["d' 6 .. 9"].rounds, came["d' 6 .. 9"].median) == (1, 6.0)
    assert sum(row.rounds for row in came.values()) == 3  # nothing was predicted, or came, in the others
    named = _figure(results, "named alone after at most six")
    assert (named.items, named.measured) == (2, 0.5)
