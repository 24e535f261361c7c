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
from compensator.lab.model.fit import fit_effects, fit_model, widened
from compensator.lab.model.gain import Gain
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Block
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


@pytest.mark.parametrize(
    ("share", "better", "verdict"), [(1.0, False, "missing"), (0.01, False, "nothing"), (0.01, True, "missing")]
)
def test_a_name_explains_most_of_what_a_scan_of_it_does_or_predicts_better(
    monkeypatch, twisted, share, better, verdict
):
    """Freely scaled, a scanned shape may explain much that the effect cannot, within its bounds."""
    fit, gathered, named = twisted
    whole = examination._as_fitted
    less = lambda one: replace(one, noncentrality=share * one.noncentrality)  # noqa: E731
    monkeypatch.setattr(examination, "_as_fitted", lambda *given: [less(one) for one in whole(*given)])
    monkeypatch.setattr(families._Family, "_predicts_better", lambda *_: better)
    assert answer_of(fit, gathered, named, None).verdict == verdict


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
        (lambda x: 0.02 * x.q, "spring", "missing", "cogging"),
        (lambda x: 0.02 * np.sin(3.0 * x.q), "cogging", "nothing", "spring"),  # what is next is but its shadow
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
    ("share", "rows", "better", "is_shadow"),
    [
        (0.7, "moving", False, False),
        (0.7, "sliding", False, False),
        (0.4, "moving", True, True),  # near reversals every joint leaves something that is predicted
        (0.4, "sliding", False, True),
        (0.4, "sliding", True, False),
    ],
)
def test_what_explains_much_less_is_a_shadow_unless_it_predicts_better_in_steady_sliding(
    monkeypatch, share, rows, better, is_shadow
):
    shapes = [
        SimpleNamespace(block=Block(name, np.empty((0, 1)), 0, 1), noncentrality=evidence)
        for name, evidence in (("spring", 100.0), ("cogging", 100.0 * share))
    ]
    family = families._Family(SimpleNamespace(show_in=rows), None, shapes, [])
    monkeypatch.setattr(families._Family, "_predicts_better", lambda *_: better)
    most, less = (SimpleNamespace(effect=effect_named(one.block.name), evidence=one) for one in shapes)
    assert family._shadow_of(most) == ""
    assert family._shadow_of(less) == ("explains little beside spring, which cannot be it" if is_shadow else "")


@pytest.mark.parametrize(("rows", "said"), [("sliding", ""), ("moving", "as it can be")])
def test_in_steady_sliding_another_order_of_an_effect_casts_no_shadow_on_it(monkeypatch, rows, said):
    """The scan holds all orders of cogging; the fit takes the one that lowers the error most."""
    scanned, fitted = (SimpleNamespace(block=Block("cogging", np.empty((0, 1)), 0, 1), noncentrality=n) for n in (9, 4))
    monkeypatch.setattr(families._Family, "_predicts_better", lambda *_: False)
    family = families._Family(SimpleNamespace(show_in=rows), None, [scanned], [])
    found = family._shadow_of(SimpleNamespace(effect=effect_named("cogging"), evidence=fitted))
    assert found.startswith(said)
    assert (found == "") == (said == "")


@pytest.mark.parametrize(("of", "better"), [("spring", True), ("cogging", False)])
def test_a_shadow_does_not_predict_better_than_what_casts_it(of, better):
    """The joint has a spring: cogging of any phase that stands for it is held against the spring itself."""
    fit = fit_model(make_dataset(recordings(SPRUNG, seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = gather(fit)
    other = next(block for block in gathered.named if block.name != of and block.name in ("spring", "cogging"))
    candidate = SimpleNamespace(explained=fit_effects(fit, [*fit.names, of]))
    assert families._Family(gathered, None, [], [])._predicts_better(candidate, other) == better
