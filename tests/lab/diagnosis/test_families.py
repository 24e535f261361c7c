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
from compensator.lab.model.linear import orthonormal
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import screen
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


@pytest.mark.parametrize(("share", "verdict"), [(1.0, "missing"), (0.1, "nothing")])
def test_a_name_explains_most_of_what_a_scan_of_it_does(monkeypatch, twisted, share, verdict):
    """Freely scaled, a scanned shape may explain much that the effect cannot, within its bounds."""
    fit, gathered, named = twisted
    whole = examination._as_fitted
    less = lambda one: replace(one, noncentrality=share * one.noncentrality)  # noqa: E731
    monkeypatch.setattr(examination, "_as_fitted", lambda *given: [less(one) for one in whole(*given)])
    monkeypatch.setattr(families, "NEARLY_ALL", 0.0)
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
    ("alike", "size", "rows", "is_shadow"),
    [
        (0.0, 1.0, "moving", False),  # all of it is its own
        (0.9, 1.0, "moving", True),
        (0.9, 1.0, "sliding", False),
        (0.0, 0.4, "moving", True),  # beside so much that nothing explains, a little is no evidence
        (0.0, 0.4, "sliding", True),
    ],
)
def test_what_explains_less_is_a_shadow_where_it_keeps_little_beside_what_explains_most(alike, size, rows, is_shadow):
    random = np.random.default_rng(6)
    most, own, noise = orthonormal(random.standard_normal((600, 3))).T
    base = Base(np.empty((600, 0)), 1.1 * most + (0.0 if alike else size) * own + noise)
    less = alike * most + np.sqrt(1.0 - alike**2) * own
    blocks = [Block("spring", most[:, None], 0, 1), Block("cogging", less[:, None], 0, 1)]
    gathered = SimpleNamespace(
        show_in=rows,
        with_block=lambda block: SimpleNamespace(bases=[base.extended(block.columns)]),
    )
    shapes = screen([base], blocks, 30).evidence
    family = families._Family(gathered, None, shapes, [])
    assert [one.block.name for one in shapes] == ["spring", "cogging"]
    assert family._shadow_of(shapes[0]) == ""
    assert family._shadow_of(shapes[1]) == ("spring" if is_shadow else "")
