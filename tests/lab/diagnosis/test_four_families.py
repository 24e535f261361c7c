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


def named(name: str) -> Answer:
    """An answer with a name, as far as other families look at it."""
    candidate: Any = SimpleNamespace(effect=effect_named(name), explained=model_of(name))
    return Answer("missing", "", 0.001, [candidate], None, [])


def model_of(name: str) -> Any:
    return SimpleNamespace(names=(name,))


BACKLASH, COGGING, DWELL = map(named, ("backlash", "cogging", "dwell_strengthening"))
ENCODER, LATER = named("encoder_eccentricity"), named("effort_filter")
CURVE = replace(NOTHING, verdict="unknown-effect", driver="time")


@pytest.mark.parametrize(
    ("steady", "memory", "rest", "chain", "better", "first"),
    [
        (NOTHING, BACKLASH, None, NOTHING, {}, BACKLASH),
        (COGGING, BACKLASH, None, ENCODER, {("encoder_eccentricity", "cogging"): "sliding"}, ENCODER),
        (COGGING, BACKLASH, None, ENCODER, {("encoder_eccentricity", "cogging"): "moving"}, COGGING),
        (COGGING, BACKLASH, None, ENCODER, {}, COGGING),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "moving"}, BACKLASH),
        (COGGING, BACKLASH, None, NOTHING, {("backlash", "cogging"): "sliding"}, COGGING),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "moving"}, LATER),
        (NOTHING, BACKLASH, None, LATER, {("effort_filter", "backlash"): "sliding"}, BACKLASH),
        (CURVE, BACKLASH, None, NOTHING, {}, BACKLASH),  # a name says more than a curve
        (CURVE, BACKLASH, None, NOTHING, {("curve", "backlash"): "moving"}, CURVE),
        (CURVE, NOTHING, DWELL, NOTHING, {}, DWELL),
        (NOTHING, NOTHING, DWELL, LATER, {("effort_filter", "dwell_strengthening"): "moving"}, DWELL),
        (COGGING, NOTHING, DWELL, NOTHING, {("dwell_strengthening", "cogging"): "moving"}, DWELL),
    ],
)
def test_a_name_is_first_that_predicts_other_trials_better(monkeypatch, steady, memory, rest, chain, better, first):
    monkeypatch.setattr(four_families, "with_curve", lambda _fit, driver: model_of("curve") if driver else None)
    monkeypatch.setattr(four_families, "widened", lambda fit, rows: (fit.names[0], rows))
    monkeypatch.setattr(four_families, "held_out", lambda model, rows: (*model, rows))
    monkeypatch.setattr(
        four_families,
        "predicts_better",
        lambda one, other: one[1] == one[2] == other[1] == better.get((one[0], other[0])),
    )
    assert FourFamilies(steady, memory, rest, chain, SimpleNamespace(fit=None), {}).first() is first
