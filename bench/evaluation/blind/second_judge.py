"""The same questions to the lab on joints of the second plant: its families of items, and how each is judged."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bench.evaluation.blind.baseline_methods import RIVALS
from bench.evaluation.blind.items import Item, listed
from bench.evaluation.blind.judge import ask_lab, ask_without, left_beside, with_known
from bench.evaluation.blind.oracle import NEEDED
from bench.evaluation.blind.recorded import base_fit
from bench.evaluation.blind.result import Result, Standing
from bench.evaluation.blind.second_plant import (
    KNOWN,
    NAMES,
    OUTSIDE,
    SecondJoint,
    recordings_of,
    rig_of,
    second_joint,
    true_parameters,
)
from bench.evaluation.blind.stated import confidences
from compensator.lab.errors import LabError
from compensator.lab.model.validation import held_out
from compensator.lab.screening.gathering import gather

OTHER_LAWS = "other-laws"


@dataclass(frozen=True)
class SecondFamily:
    """A kind of item.

    Attributes:
        name: as in the table of results.
        per_plant: how many for each plant asked for.
        names: mechanisms that come in turn.
        count: how many are hidden.
        ratios: r of each, drawn from here (log).
        other_laws: share of the joints whose friction follows laws that the base model does not have.
    """

    name: str
    per_plant: int
    names: tuple[str, ...]
    count: int
    ratios: tuple[float, float] = (0.1, 1.0)
    other_laws: float = 0.5


SECOND_FAMILIES: dict[str, SecondFamily] = {
    family.name: family
    for family in (
        SecondFamily("complete", 2, (), 0, other_laws=0.0),
        SecondFamily(OTHER_LAWS, 1, (), 0, other_laws=1.0),
        SecondFamily("single", 3, KNOWN, 1),
        SecondFamily("pair", 1, KNOWN, 2, (0.35, 1.0)),
        SecondFamily("outside", 2, OUTSIDE, 1, (0.3, 1.2)),
    )
}


def second_items_of(seed: int, plants: int, only: Sequence[str] = ()) -> list[Item]:
    """Every item of a run, as `items_of`."""
    per_plant = {name: family.per_plant for name, family in SECOND_FAMILIES.items()}
    return listed(per_plant, seed, plants, only, "second-", (2,))


def draw_second(item: Item) -> SecondJoint:
    """The joint of an item."""
    family, random = SECOND_FAMILIES[item.family], np.random.default_rng(item.seed)
    level = "foreign" if random.random() < family.other_laws else "textbook"
    names: tuple[str, ...] = ()
    if family.count == 1:
        names = (family.names[item.turn % len(family.names)],)
    elif family.count > 1:
        names = tuple(str(name) for name in random.choice(family.names, family.count, replace=False))
    ratios = tuple(float(np.exp(random.uniform(*np.log(family.ratios)))) for _ in names)
    return second_joint(int(random.integers(2**31)), names, ratios, level)  # type: ignore[arg-type]


def judge_second(item: Item) -> Result:
    """Draw, record, ask."""
    joint = draw_second(item)
    names = tuple(NAMES.get(truth, "") for truth in joint.truths)
    standings: tuple[Standing | None, ...] = tuple(
        Standing(
            one.ratio, one.detectability, NAMES.get(one.rival, one.rival), float(np.sqrt(NEEDED / one.independent))
        )
        for one in joint.evidences
    )
    outside = float(np.hypot(1.0, joint.evidences[0].ratio)) if names == ("",) else None
    try:
        fit = base_fit(recordings_of(joint), rig_of(joint))
        began = time.process_time()
        answer = ask_lab(fit, several=len(names) > 1 or bool(joint.own))
        seconds = time.process_time() - began
        gathered = gather(fit)
        error = held_out(with_known(fit, names)[0]).relative
        rivals = {name: rival(gathered) for name, rival in RIVALS.items()}
        stated = confidences(fit, true_parameters(joint)) if item.family == "complete" else ()
        unlisted = ask_without(fit, names[:1]) if item.family == "single" else None
        left = None if unlisted is None else left_beside(fit, gathered, names[0], unlisted.first[:1])
    except LabError as refusal:
        return Result(
            item.key, item.family, joint.truths, names, joint.sizes, None, standings, outside, float("nan"),
            refusal=str(refusal), laws=joint.laws, own=joint.own,
        )  # fmt: skip
    return Result(
        item.key, item.family, joint.truths, names, joint.sizes, answer, standings, outside, error, rivals, seconds,
        withheld=unlisted, withheld_left=left, laws=joint.laws, own=joint.own, confidences=stated,
    )  # fmt: skip
