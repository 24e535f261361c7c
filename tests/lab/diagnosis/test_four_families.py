"""Which of four families has the answer: what is but the shadow of another family's effect has not."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from compensator.lab.diagnosis import four_families
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.four_families import FourFamilies
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.gain import Gain
from compensator.lab.model.linear import orthonormal
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import screen

NOTHING = Answer("nothing", "", 1.0, [], None, [])


SURE = Gain(0.3, 0.2, 0.4)


def named(name: str, evidence: float = 100.0, gain: Gain = SURE) -> Answer:
    """An answer with a name, as far as other families look at it."""
    said = SimpleNamespace(noncentrality=evidence)
    candidate: Any = SimpleNamespace(effect=effect_named(name), explained=model_of(name), evidence=said, gain=gain)
    return Answer("missing", "", 0.001, [candidate], None, [])


def unseen(name: str) -> Answer:
    """One whose effect does not show in motion."""
    candidate: Any = SimpleNamespace(effect=effect_named(name), explained=None, evidence=None, gain=SURE)
    return Answer("missing", "", 0.001, [candidate], None, [])


def model_of(name: str) -> Any:
    return SimpleNamespace(names=(name,))


BACKLASH, COGGING, DWELL = map(named, ("backlash", "cogging", "dwell_strengthening"))
BRISTLES = named("pre_sliding", 110.0)
ENCODER, LATER = named("encoder_eccentricity", 90.0), named("effort_filter", 200.0)
CURVE = replace(NOTHING, verdict="unknown-effect", driver="time")
UNSEEN = unseen("rate_dependent_breakaway")
LITTLE = named("frictional_lag", gain=Gain(0.04, 0.03, 0.05))


@pytest.mark.parametrize(
    ("steady", "memory", "rest", "chain", "better", "shadow", "first"),
    [
        (NOTHING, BACKLASH, None, NOTHING, {}, "", BACKLASH),
        (COGGING, BACKLASH, None, ENCODER, {("encoder_eccentricity", "cogging"): "sliding"}, "cogging", ENCODER),
        (COGGING, BACKLASH, None, ENCODER, {("encoder_eccentricity", "cogging"): "sliding"}, "", COGGING),
        (COGGING, BACKLASH, None, ENCODER, {}, "cogging", COGGING),
        (COGGING, BACKLASH, None, LATER, {("effort_filter", "cogging"): "sliding"}, "", COGGING),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "moving"}, "cogging", BACKLASH),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "moving"}, "", COGGING),
        (COGGING, BRISTLES, None, NOTHING, {("pre_sliding", "cogging"): "moving"}, "", BRISTLES),  # more evidence
        (COGGING, BRISTLES, None, NOTHING, {("pre_sliding", "cogging"): "sliding"}, "", COGGING),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "moving"}, "backlash", LATER),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "sliding"}, "backlash", BACKLASH),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "moving"}, "", BACKLASH),
        (CURVE, BACKLASH, None, NOTHING, {}, "", BACKLASH),  # a name says more than a curve
        (CURVE, BACKLASH, None, NOTHING, {("curve", "backlash"): "moving"}, "", CURVE),
        (CURVE, NOTHING, DWELL, NOTHING, {}, "", DWELL),
        (CURVE, NOTHING, UNSEEN, NOTHING, {}, "", CURVE),
        (NOTHING, NOTHING, DWELL, LATER, {("effort_filter", "dwell_strengthening"): "moving"}, "", DWELL),
        (COGGING, NOTHING, DWELL, NOTHING, {("dwell_strengthening", "cogging"): "moving"}, "cogging", DWELL),
        (NOTHING, NOTHING, UNSEEN, ENCODER, {}, "", UNSEEN),
        (NOTHING, LITTLE, None, NOTHING, {}, "", LITTLE),
        (NOTHING, LITTLE, DWELL, NOTHING, {}, "", DWELL),  # whatever is missing leaves a little near reversals
        (NOTHING, LITTLE, None, ENCODER, {}, "", ENCODER),
    ],
)
def test_a_name_is_first_that_predicts_better_and_has_more_evidence_or_leaves_none(
    monkeypatch, steady, memory, rest, chain, better, shadow, first
):
    monkeypatch.setattr(four_families, "with_curve", lambda _fit, driver: model_of("curve") if driver else None)
    monkeypatch.setattr(four_families, "widened", lambda fit, rows: (fit.names[0], rows))
    monkeypatch.setattr(four_families, "held_out", lambda model, rows: (*model, rows))
    monkeypatch.setattr(four_families, "_is_shadow", lambda one, *_: one.candidates[0].effect.name == shadow)
    monkeypatch.setattr(
        four_families,
        "predicts_better",
        lambda one, other: one[1] == one[2] == other[1] == better.get((one[0], other[0])),
    )
    assert FourFamilies(steady, memory, rest, chain, SimpleNamespace(fit=None), {}).first() is first


@pytest.mark.parametrize(("alike", "is_shadow"), [(0.95, True), (0.0, False)])
def test_a_shadow_loses_its_evidence_once_the_other_effect_is_in_the_model(alike, is_shadow):
    random = np.random.default_rng(3)
    true, own = orthonormal(random.standard_normal((600, 2))).T
    base = Base(np.empty((600, 0)), 12.0 * true + 4.0 * (not is_shadow) * own + random.standard_normal(600))
    less = alike * true + np.sqrt(1.0 - alike**2) * own
    evidence = screen([base], [Block("cogging", less[:, None], 0, 1)], 50).evidence[0]
    gathered: Any = SimpleNamespace(
        fit=SimpleNamespace(dataset=SimpleNamespace(unchecked_columns=lambda *_: [true[:, None]])),
        tested=lambda columns: columns,
        with_block=lambda block: SimpleNamespace(bases=[base.extended(block.columns)]),
    )
    first: Any = SimpleNamespace(candidates=[SimpleNamespace(evidence=evidence)], gathered=gathered)
    other: Any = SimpleNamespace(effect=effect_named("backlash"))
    assert four_families._is_shadow(first, other, cast(Any, SimpleNamespace(shapes={}))) == is_shadow
