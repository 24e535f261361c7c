"""Which of four families has the answer: what is but the shadow of another family's effect has not."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from compensator.lab.diagnosis import four_families
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.four_families import FourFamilies, _evidence_beside
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.evidence import kept_evidence
from compensator.lab.screening.gathering import gather
from tests.lab.diagnosis.test_diagnose import bristles
from tests.lab.synthetic import FACTS, Joint, recordings

NOTHING = Answer("nothing", "", 1.0, [], None, [])


def named(name: str, strength: float, gain: float = 0.2) -> Answer:
    """An answer with a name, as far as other families look at it."""
    candidate: Any = SimpleNamespace(effect=effect_named(name), shape=(), gain=SimpleNamespace(value=gain))
    evidence: Any = SimpleNamespace(block=SimpleNamespace(name=name))
    return Answer("missing", "", 0.001, [candidate], None, [], strength, named=evidence)


BACKLASH, COGGING = named("backlash", 40.0), named("cogging", 30.0)
ENCODER = named("encoder_eccentricity", 60.0, gain=0.3)


@pytest.mark.parametrize(
    ("steady", "chain", "kept", "first"),
    [
        (NOTHING, NOTHING, {}, "backlash"),
        (COGGING, ENCODER, {"backlash": 35.0, "encoder_eccentricity": 20.0}, "encoder_eccentricity"),  # over cogging
        (COGGING, NOTHING, {"backlash": 35.0}, "backlash"),  # of which cogging is the shadow
        (COGGING, NOTHING, {"backlash": 25.0}, "cogging"),
    ],
)
def test_an_effect_with_memory_is_first_where_what_shows_in_sliding_is_its_shadow(
    monkeypatch, steady, chain, kept, first
):
    monkeypatch.setattr(four_families, "_evidence_beside", lambda _gathered, name, _other: kept[name])
    gathered: Any = SimpleNamespace()
    judged = FourFamilies(steady, BACKLASH, None, chain, gathered, gathered, {})
    assert judged.first().candidates[0].effect.name == first


def test_what_shows_at_starts_from_rest_is_no_shadow_of_the_chains(monkeypatch):
    """Where it alone explains a curve that no formula follows, memory and chain have a little of that as well."""
    kept = {"backlash": 12.0, "encoder_eccentricity": 58.0}
    monkeypatch.setattr(four_families, "_evidence_beside", lambda _gathered, name, _other: kept[name])
    curve, dwell = replace(NOTHING, verdict="unknown-effect", strength=200.0), named("dwell_strengthening", 195.0)
    gathered: Any = SimpleNamespace()
    judged = FourFamilies(curve, BACKLASH, dwell, ENCODER, gathered, gathered, {})
    assert judged.first() is dwell


def test_an_effect_keeps_its_evidence_beside_what_has_nothing_of_it_and_none_beside_itself():
    dataset = make_dataset(recordings(Joint(extra=bristles), seed=4), FACTS, Processing())
    gathered = gather(widened(fit_model(dataset, default_effects(FACTS)), "moving"), "moving")
    name = "pre_sliding"
    block = next(block for block in gathered.named if block.name == name)
    gathered = replace(gathered, named=[block])
    alone = kept_evidence(gathered.bases, [block])[name]
    itself: Any = SimpleNamespace(effect=effect_named(name), shape=block.key)
    spring: Any = SimpleNamespace(effect=effect_named("spring"), shape=())
    assert alone > 50.0
    assert _evidence_beside(gathered, name, itself) < 1e-6 * alone
    assert _evidence_beside(gathered, name, spring) == pytest.approx(alone, rel=0.1)
