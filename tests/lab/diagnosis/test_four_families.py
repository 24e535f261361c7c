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


def named(name: str, strength: float, gain: float = 0.2) -> Answer:
    """An answer with a name, as far as other families look at it."""
    candidate: Any = SimpleNamespace(effect=effect_named(name), shape=(), gain=SimpleNamespace(value=gain))
    explained: Any = SimpleNamespace(names=(name,))
    return Answer("missing", "", 0.001, [candidate], None, [], strength, gain, explained=explained)


BACKLASH, COGGING = named("backlash", 40.0), named("cogging", 300.0)
ENCODER = named("encoder_eccentricity", 600.0, gain=0.3)


@pytest.mark.parametrize(
    ("steady", "chain", "better", "first"),
    [
        (NOTHING, NOTHING, {}, "backlash"),
        (COGGING, ENCODER, {"encoder_eccentricity": "sliding"}, "encoder_eccentricity"),
        (COGGING, ENCODER, {}, "cogging"),  # however strongly the chain's shows
        (COGGING, replace(ENCODER, strength=200.0), {"encoder_eccentricity": "sliding"}, "cogging"),
        (COGGING, NOTHING, {"backlash": "moving"}, "backlash"),  # however strongly cogging shows in sliding
        (COGGING, NOTHING, {}, "cogging"),
    ],
)
def test_another_family_is_first_where_it_predicts_better(monkeypatch, steady, chain, better, first):
    monkeypatch.setattr(four_families, "widened", lambda fit, rows: (fit.names[0], rows))
    monkeypatch.setattr(four_families, "held_out", lambda model, rows: (*model, rows))
    monkeypatch.setattr(
        four_families,
        "predicts_better",
        lambda one, other: other[0] == "cogging" and one[1] == one[2] == better.get(one[0]),
    )
    judged = FourFamilies(steady, BACKLASH, None, chain, SimpleNamespace(), {})
    assert judged.first().candidates[0].effect.name == first


def test_what_shows_at_starts_from_rest_is_no_shadow_of_the_chains():
    """Where it alone explains a curve that no formula follows, memory and chain have a little of that as well."""
    curve, dwell = replace(NOTHING, verdict="unknown-effect", strength=200.0), named("dwell_strengthening", 195.0)
    chain = replace(ENCODER, strength=60.0)
    assert FourFamilies(curve, BACKLASH, dwell, chain, SimpleNamespace(), {}).first() is dwell
