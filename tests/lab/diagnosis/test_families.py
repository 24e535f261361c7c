"""What one family of effects says: a name must hold with all shapes found anew, as its model has them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from compensator.lab.diagnosis import examination, families
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.families import answer_of
from compensator.lab.diagnosis.note import Note
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_effects, fit_model, widened
from compensator.lab.model.gain import Gain
from compensator.lab.model.linear import orthonormal
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.between_scanned import with_shapes_between
from compensator.lab.screening.evidence import screen, screen_against_noise
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
    gathered = with_shapes_between(gather(fit, "moving"))
    return fit, gathered, screen(gathered.bases, gathered.named, fit.dataset.block_index[gathered.rows])


@pytest.mark.parametrize(
    ("gain", "found", "verdict"),
    [
        (Gain(0.3, 0.2, 0.4), {}, "missing"),
        (Gain(-0.1, -0.2, -0.0), {}, "nothing"),
        (Gain(0.3, 0.2, 0.4), {"shape": (50.0, 0.1)}, "nothing"),  # nor is one missing that is as stiff as told
        (
            Gain(0.3, 0.2, 0.4),
            {"coefficients": np.array([0.3]), "at_bound": np.array([True])},
            "nothing",
        ),  # a part of it
    ],
)
def test_near_reversals_a_name_must_hold_in_the_model_that_would_be_had(monkeypatch, twisted, gain, found, verdict):
    fit, gathered, named = twisted
    monkeypatch.setattr(families, "as_in_the_ladder", lambda candidate, *_: replace(candidate, gain=gain))
    if found:
        grown = fit_effects(fit, [*fit.names, "elasticity"])
        terms = [replace(one, **found) if one.effect.name == "elasticity" else one for one in grown.terms]
        monkeypatch.setattr(families, "fit_effects", lambda *_: replace(grown, terms=terms))
    answer = answer_of(fit, gathered, named, None)
    assert answer.candidates[0].effect.name == "elasticity"
    assert answer.verdict == verdict
    assert (answer.explained is not None) == (verdict == "missing")


@pytest.mark.parametrize(("low", "verdict"), [(0.2, "unknown-effect"), (-0.1, "nothing")])
def test_what_shows_near_reversals_for_sure_and_cannot_be_its_formula_is_none_of_the_catalogue(
    monkeypatch, twisted, low, verdict
):
    """As a base that rocks looks like a spring beyond the gear, with another load than the joint's."""
    fit, gathered, named = twisted
    impossible = "it would be 0.2, allowed 0.3 to 3"
    monkeypatch.setattr(
        families,
        "examine",
        lambda *given: [
            replace(one, gain=Gain(0.3, low, 0.4), impossible=impossible) for one in examination.examine(*given)
        ],
    )
    monkeypatch.setattr(families, "is_within_bounds", lambda *_: False)
    answer = answer_of(fit, gathered, named, None)
    assert (answer.verdict, answer.remains) == (verdict, verdict == "unknown-effect")
    assert (f"joint elasticity, cannot be it: {impossible}" in answer.sentence) == answer.remains


def test_in_steady_sliding_what_cannot_be_its_formula_is_left_to_free_curves(monkeypatch):
    """As a filter of the measuring chain that would have to be a small part of the effort."""
    fit = fit_model(make_dataset(recordings(SPRUNG, seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    assert gathered.noise is not None
    sure = {"gain": Gain(0.3, 0.2, 0.4), "impossible": "it cannot be"}
    monkeypatch.setattr(
        families, "examine", lambda *given: [replace(one, **sure) for one in examination.examine(*given)]
    )
    monkeypatch.setattr(families, "is_within_bounds", lambda *_: False)
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, screen_against_noise(gathered.bases, blocks, gathered.noise), None)
    assert answer.verdict == "nothing"


@pytest.mark.parametrize(("gain", "left", "said"), [(0.1, True, True), (0.1, False, False), (0.5, True, False)])
def test_a_name_that_explains_the_smaller_part_and_leaves_more_than_noise_says_so(
    monkeypatch, twisted, gain, left, said
):
    fit, gathered, named = twisted
    sure = Gain(gain, 0.06, 0.6)
    monkeypatch.setattr(families, "as_in_the_ladder", lambda candidate, *_: replace(candidate, gain=sure))
    monkeypatch.setattr(families, "what_remains", lambda *_: [Note("recurs", "Something is left.")] if left else [])
    answer = answer_of(fit, gathered, named, None)
    assert answer.verdict == "missing"
    assert ("explains 19% of the error's power" in answer.sentence) == said


@pytest.mark.parametrize(("gain", "verdict"), [(Gain(0.3, 0.2, 0.4), "missing"), (Gain(-0.1, -0.2, 0.1), "nothing")])
def test_in_steady_sliding_a_name_must_hold_in_the_model_that_would_be_had(monkeypatch, gain, verdict):
    made = recordings(Joint(extra=lambda x: 0.02 * np.sin(3.0 * x.q)), seed=4)
    fit = fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    monkeypatch.setattr(families, "as_in_the_ladder", lambda candidate, *_: replace(candidate, gain=gain))
    assert gathered.noise is not None
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, screen_against_noise(gathered.bases, blocks, gathered.noise), None)
    assert (answer.verdict, answer.candidates[0].effect.name) == (verdict, "cogging")
    assert (answer.explained is not None) == (verdict == "missing")


@pytest.mark.parametrize(
    ("extra", "cannot_be", "verdict", "first"),
    [
        (lambda x: 0.02 * x.q, "spring", "missing", "cogging"),
        (lambda x: 0.02 * np.sin(3.0 * x.q), "cogging", "nothing", "cogging"),  # what is next is but its shadow
    ],
)
def test_what_does_not_hold_leaves_its_place_to_the_next(monkeypatch, extra, cannot_be, verdict, first):
    fit = fit_model(make_dataset(recordings(Joint(extra=extra), seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    monkeypatch.setattr(families, "why_impossible", lambda _fit, name: "it cannot be" if name == cannot_be else "")
    assert gathered.noise is not None
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    answer = answer_of(fit, gathered, screen_against_noise(gathered.bases, blocks, gathered.noise), None)
    assert (answer.verdict, answer.candidates[0].effect.name) == (verdict, first)


def test_a_gain_that_is_not_sure_gives_no_name_where_what_is_left_comes_in_bursts(monkeypatch):
    """Strong evidence does without a sure gain where the noise is alike everywhere."""
    fit = fit_model(make_dataset(recordings(SPRUNG, seed=4), FACTS, Processing()), default_effects(FACTS))
    gathered = with_noise(gather(fit))
    assert gathered.noise is not None
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    named = screen_against_noise(gathered.bases, blocks, gathered.noise)
    unsure = Gain(0.3, -0.1, 0.4)
    monkeypatch.setattr(families, "as_in_the_ladder", lambda candidate, *_: replace(candidate, gain=unsure))
    assert answer_of(fit, gathered, named, None).verdict == "missing"
    monkeypatch.setattr(families, "large_bursts", lambda _: object())
    answer = answer_of(fit, gathered, named, None)
    assert answer.verdict == "nothing"
    assert "in bursts" in answer.candidates[0].refused


SPRUNG = Joint(extra=lambda x: 0.05 * x.q)


def test_what_a_shape_of_the_model_has_taken_is_looked_for_with_all_shapes_anew(monkeypatch):
    """With shapes that are held, its gain may be next to nothing, as that of drag beside a Stribeck curve of it."""
    fit = fit_model(make_dataset(recordings(SPRUNG, seed=5), FACTS, Processing(8.0)), default_effects(FACTS))
    monkeypatch.setattr(examination, "with_effect", lambda held, *_: held)
    found = diagnose(fit)
    assert (found.verdict, found.candidates[0].effect.name) == ("missing", "spring"), found.sentence
    assert found.candidates[0].gain.value > 0.1


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
    shapes = screen([base], blocks, np.arange(600) // 20).evidence
    gathered = SimpleNamespace(
        show_in=rows, noise=None, with_block=lambda block: SimpleNamespace(bases=[base.extended(block.columns)])
    )
    family = families._Family(None, gathered, None, shapes, [])
    assert [one.block.name for one in shapes] == ["spring", "cogging"]
    assert not family._is_shadow(shapes[0])
    assert family._is_shadow(shapes[1]) == is_shadow
