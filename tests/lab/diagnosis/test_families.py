"""What one family of effects says: a name must hold with all shapes found anew, as its model has them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from compensator.lab.diagnosis import examination, families
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.families import answer_of
from compensator.lab.diagnosis.note import Note
from compensator.lab.diagnosis.physical import POSSIBLE, Impossible
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.model.gain import Gain
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import WITH_CHAIN
from compensator.lab.screening.evidence import kept_evidence
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.diagnosis.test_diagnose import SHAKEN
from tests.lab.far_side import ARM_KG_M2, twisting
from tests.lab.synthetic import FACTS, Joint, plans, recordings


@pytest.fixture(scope="module")
def twisted():
    """A model whose joint's shaft twists, what it may be missing, and how strongly that shows."""
    stiffness = ARM_KG_M2 * (2.0 * np.pi * 60.0) ** 2
    drawn = replace(FACTS, arm_inertia_kg_m2=ARM_KG_M2, stiffness_n_m_rad=stiffness)
    made = recordings(Joint(extra=twisting), trials=[*plans((0.0, 0.25))[::2], *SHAKEN[::2]], seed=4)
    fit = widened(fit_model(make_dataset(made, drawn, Processing()), default_effects(drawn)), "moving")
    gathered = with_noise(gather(fit, "moving"))
    return fit, gathered, gathered.screened(gathered.named)


SURE = Gain(0.3, 0.2, 0.4)


@pytest.mark.parametrize(
    ("gain", "found", "verdict"),
    [
        (SURE, {}, "missing"),
        (Gain(-0.1, -0.2, -0.0), {}, "nothing"),
        (SURE, {"shape": (50.0, 0.1, 1.0)}, "nothing"),  # nor is one missing that is as stiff as told
        (SURE, {"coefficients": np.array([0.3]), "at_bound": np.array([True])}, "nothing"),  # a part of it
    ],
)
def test_near_reversals_a_name_must_hold_in_the_model_that_would_be_had(monkeypatch, twisted, gain, found, verdict):
    fit, gathered, named = twisted
    monkeypatch.setattr(examination, "held_out_gain", lambda *_: gain)
    fitted = examination.fit_effects

    def changed(fit, names, *sliding):
        grown = fitted(fit, names, *sliding)
        terms = [replace(one, **found) if one.effect.name == "elasticity" else one for one in grown.terms]
        return replace(grown, terms=terms)

    monkeypatch.setattr(examination, "fit_effects", changed)
    answer = answer_of(fit, gathered, named, None)
    elasticity = next(one for one in answer.candidates if one.effect.name == "elasticity")
    if verdict == "missing":
        assert answer.candidates[0] is elasticity
        assert answer.explained is elasticity.explained
    assert is_confirmed(elasticity) == (verdict == "missing")


def test_in_steady_sliding_what_cannot_be_its_formula_is_left_to_free_curves(monkeypatch):
    """As a filter of the measuring chain that would have to be a small part of the effort."""
    fit = fit_model(make_dataset(recordings(SPRUNG, seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    sure = {"gain": Gain(0.3, 0.2, 0.4), "impossible": "it cannot be"}
    monkeypatch.setattr(
        families, "examine", lambda *given: [replace(one, **sure) for one in examination.examine(*given)]
    )
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, gathered.screened(blocks), None)
    assert answer.verdict == "nothing"


@pytest.mark.parametrize(("gain", "left", "said"), [(0.1, True, True), (0.1, False, False), (0.5, True, False)])
def test_a_name_that_explains_the_smaller_part_and_leaves_more_than_noise_says_so(
    monkeypatch, twisted, gain, left, said
):
    fit, gathered, named = twisted
    sure = Gain(gain, 0.06, 0.6)
    monkeypatch.setattr(examination, "held_out_gain", lambda *_: sure)
    monkeypatch.setattr(families, "what_remains", lambda *_: [Note("recurs", "Something is left.")] if left else [])
    answer = answer_of(fit, gathered, named, None)
    assert answer.verdict == "missing"
    assert ("explains 19% of the error's power" in answer.sentence) == said


@pytest.mark.parametrize(("gain", "verdict"), [(Gain(0.3, 0.2, 0.4), "missing"), (Gain(-0.1, -0.2, 0.1), "nothing")])
def test_in_steady_sliding_a_name_must_hold_in_the_model_that_would_be_had(monkeypatch, gain, verdict):
    made = recordings(Joint(extra=lambda x: 0.02 * np.sin(3.0 * x.q)), seed=4)
    fit = fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    monkeypatch.setattr(examination, "held_out_gain", lambda *_: gain)
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, gathered.screened(blocks), None)
    assert (answer.verdict, answer.candidates[0].effect.name) == (verdict, "cogging")
    assert (answer.explained is not None) == (verdict == "missing")


@pytest.mark.parametrize(
    ("extra", "cannot_be", "verdict", "first"),
    [
        (lambda x: 0.02 * x.q, "spring", "missing", "hardening_spring"),
        (lambda x: 0.02 * np.sin(3.0 * x.q), "cogging", "missing", "hardening_spring"),  # it helps on other trials
    ],
)
def test_what_does_not_hold_leaves_its_place_to_the_next(monkeypatch, extra, cannot_be, verdict, first):
    fit = fit_model(make_dataset(recordings(Joint(extra=extra), seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    cannot = Impossible("it cannot be", "unphysical size")
    monkeypatch.setattr(examination, "why_impossible", lambda _, name: cannot if name == cannot_be else POSSIBLE)
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, gathered.screened(blocks), None)
    assert (answer.verdict, answer.candidates[0].effect.name) == (verdict, first)


SPRUNG = Joint(extra=lambda x: 0.05 * x.q)


@pytest.mark.parametrize(
    ("share", "rows", "is_better", "is_shadow"),
    [
        (0.7, "moving", False, False),
        (0.4, "moving", False, True),
        (0.4, "moving", True, False),  # on other trials
        (0.4, "sliding", False, False),
    ],
)
def test_near_reversals_what_explains_much_less_is_a_shadow(monkeypatch, share, rows, is_better, is_shadow):
    shapes = [
        SimpleNamespace(block=Block(name, np.empty((0, 1)), 0, 1), noncentrality=evidence)
        for name, evidence in (("backlash", 100.0), ("elasticity", 100.0 * share))
    ]
    most, less = (
        SimpleNamespace(effect=effect_named(one.block.name), evidence=one, explained=one.block.name) for one in shapes
    )
    family = families._Family(SimpleNamespace(show_in=rows), None, shapes, [most, less])
    monkeypatch.setattr(families._Family, "_beside_chain", lambda _, one: one.noncentrality)
    monkeypatch.setattr(families, "held_out", lambda model, rows: (model, rows))
    better = (("elasticity", "moving"), ("backlash", "moving"))
    monkeypatch.setattr(families, "predicts_better", lambda *two: is_better and two == better)
    assert family._shadow_of(most) == ""
    assert family._shadow_of(less) == ("explains little beside backlash, which cannot be it" if is_shadow else "")


def test_what_every_contact_gives_casts_no_shadow():
    """Pre-sliding of the shortest distance explains most of what it does near reversals, and none of it beside that."""
    made = recordings(Joint(), trials=[*plans(), *SHAKEN], seed=4)
    fit = widened(fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS)), "moving")
    gathered = with_noise(gather(fit, "moving"))
    shortest = next(block for block in gathered.named if block.name == "pre_sliding")
    assert shortest.base != WITH_CHAIN
    base = gathered.bases[shortest.base]
    bent = Base.of(base.basis, base.residual + 50.0 * shortest.columns[:, 0] / np.linalg.norm(shortest.columns))
    chain = Base.of(gathered.bases[WITH_CHAIN].basis, bent.residual)
    bases = [chain if index == WITH_CHAIN else bent for index in range(len(gathered.bases))]
    family = families._Family(replace(gathered, bases=bases), None, [], [])
    item = gathered.screened([shortest]).evidence[0]
    assert kept_evidence(bases, [shortest])["pre_sliding"] > 100.0
    assert family._beside_chain(item) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({}, True),
        ({"gain": Gain(0.3, 0.04, 0.4)}, False),  # as little as every measuring chain bends
        ({"impossible": "it cannot be"}, False),
        ({"p_value": 0.001, "score": 20.0}, False),  # it is named
    ],
)
def test_what_predicts_better_for_sure_and_may_be_luck_is_a_note_and_no_answer(monkeypatch, changes, told):
    fit = fit_model(make_dataset(recordings(Joint(), seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    blocks = [block for block in gathered.named if block.name == "spring"]
    as_if = {"gain": Gain(0.4, 0.3, 0.5), "p_value": 0.4, "score": -1.0, "before": 0.02, "after": 0.01, **changes}
    examined = examination.examine
    monkeypatch.setattr(families, "examine", lambda *given: [replace(one, **as_if) for one in examined(*given)])
    monkeypatch.setattr(families, "unfollowed", lambda *_: None)
    answer = answer_of(fit, gathered, gathered.screened(blocks), gathered.screened(gathered.curves.blocks))
    notes = [note for note in answer.notes if note.code == "helps"]
    assert [note.values["effect"] for note in notes] == ["spring"] * told
    if told:
        assert (answer.verdict, answer.remains) == ("nothing", False)
        assert "gain 40%, 90 % interval 30% .. 50%" in notes[0].text
        assert "p = 0.4" in notes[0].text
