"""Which of four families has the answer: what is but the shadow of another family's effect has not."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from compensator.lab.diagnosis import four_families
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.four_families import FourFamilies
from compensator.lab.effects.catalogue import effect_named

NOTHING = Answer("nothing", "", 1.0, [], None, [])


def named(name: str, evidence: float = 100.0) -> Answer:
    """An answer with a name, as far as other families look at it."""
    said = SimpleNamespace(noncentrality=evidence)
    candidate: Any = SimpleNamespace(effect=effect_named(name), explained=model_of(name), evidence=said)
    return Answer("missing", "", 0.001, [candidate], None, [])


def unseen(name: str) -> Answer:
    """One whose effect does not show in motion."""
    candidate: Any = SimpleNamespace(effect=effect_named(name), explained=None, evidence=None)
    return Answer("missing", "", 0.001, [candidate], None, [])


def model_of(name: str) -> Any:
    return SimpleNamespace(names=(name,))


BACKLASH, COGGING, DWELL = map(named, ("backlash", "cogging", "dwell_strengthening"))
ENCODER, DELAY = named("encoder_eccentricity", 90.0), named("measurement_delay", 90.0)
LATER = named("effort_filter", 200.0)
CURVE = replace(NOTHING, verdict="unknown-effect", driver="time")
UNSEEN = unseen("rate_dependent_breakaway")


@pytest.mark.parametrize(
    ("steady", "memory", "rest", "chain", "better", "first"),
    [
        (NOTHING, BACKLASH, None, NOTHING, {}, BACKLASH),
        (COGGING, BACKLASH, None, ENCODER, {("encoder_eccentricity", "cogging"): "sliding"}, ENCODER),
        (COGGING, BACKLASH, None, ENCODER, {}, COGGING),
        (COGGING, BACKLASH, None, DELAY, {("measurement_delay", "cogging"): "sliding"}, COGGING),
        (COGGING, BACKLASH, None, LATER, {("effort_filter", "cogging"): "sliding"}, LATER),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "moving"}, BACKLASH),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "sliding"}, COGGING),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "moving"}, LATER),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "sliding"}, BACKLASH),
        (NOTHING, BACKLASH, None, DELAY, {("measurement_delay", "backlash"): "moving"}, BACKLASH),
        (CURVE, BACKLASH, None, NOTHING, {}, BACKLASH),  # a name says more than a curve
        (CURVE, BACKLASH, None, NOTHING, {("curve", "backlash"): "moving"}, CURVE),
        (CURVE, NOTHING, DWELL, NOTHING, {}, DWELL),
        (CURVE, NOTHING, UNSEEN, NOTHING, {}, CURVE),
        (NOTHING, NOTHING, DWELL, LATER, {("effort_filter", "dwell_strengthening"): "sliding"}, DWELL),
        (NOTHING, NOTHING, DWELL, LATER, {("effort_filter", "dwell_strengthening"): "moving"}, DWELL),
        (COGGING, NOTHING, DWELL, NOTHING, {("dwell_strengthening", "cogging"): "moving"}, DWELL),
        (NOTHING, NOTHING, UNSEEN, ENCODER, {("encoder_eccentricity", "rate_dependent_breakaway"): "sliding"}, UNSEEN),
    ],
)
def test_a_name_is_first_where_it_predicts_better_and_before_a_curve_that_does_not(
    monkeypatch, steady, memory, rest, chain, better, first
):
    monkeypatch.setattr(four_families, "with_curve", lambda _fit, driver: model_of("curve") if driver else None)
    monkeypatch.setattr(four_families, "widened", lambda fit, rows: (fit.names[0], rows))
    monkeypatch.setattr(four_families, "held_out", lambda model, rows: (*model, rows))
    monkeypatch.setattr(
        four_families,
        "predicts_better",
        lambda one, other: one[1] == one[2] == other[1] == better.get((one[0], other[0])),
    )
    assert FourFamilies(steady, memory, rest, chain, SimpleNamespace(fit=None), {}).first() is first
