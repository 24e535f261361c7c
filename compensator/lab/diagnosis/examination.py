"""Examine candidates: refit with each, measure the gain on held-out rows, find its rivals."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from compensator.lab import progress
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.physical import badge_of, why_not_physical
from compensator.lab.diagnosis.pictures import picture_of
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.model.fit import fit_effects, fit_sliding, with_effect
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import STRONG, VERY_STRONG, Evidence, kept_evidence, new_directions

EXPLAINED_BY_RIVAL = 0.5  # share of its evidence that a rival loses once the best effect is in the model
FORMULA_SHARE = 0.6  # of a free curve's evidence, or of the best formula's: one that reaches less is not the right one
NAMED_ALONE = 3.0  # d' below which a name given alone would be wrong once in four (docs/explanation/diagnosis.md)


def best_shapes(evidence: list[Evidence], can_be: Callable[[Evidence], bool] = lambda _: True) -> list[Evidence]:
    """The best shape of every effect, best effect first, of evidence in that order.

    Where the best shape cannot be the effect's, it gives way to one that can and is not surely worse: far below its
    resonance, a spring shows how much it gives, and hardly how it is damped.
    """
    own: dict[str, list[Evidence]] = {}
    for item in evidence:
        own.setdefault(item.block.name, []).append(item)
    alike = ([one for one in shapes if one.score > shapes[0].score - STRONG] for shapes in own.values())
    best = [next(filter(can_be, shapes), shapes[0]) for shapes in alike]
    return sorted(best, key=lambda item: -item.score)


def examine(fit: Fit, gathered: Candidates, evidence: list[Evidence]) -> list[Candidate]:
    """Candidates for the best shape of each effect: those that are confirmed, then the rest; each by score.

    Of those that are confirmed, one with about as much evidence that predicts other trials better for sure goes first.
    """
    before = _held_out(fit, gathered.show_in)
    sliding = None if gathered.show_in == "sliding" else fit_sliding(fit.dataset, fit.names, fit.training, fit.shapes)
    fits = [with_effect(fit, item.block.name, item.block.shape, sliding) for item in progress.each(evidence)]
    afters = [_held_out(explained, gathered.show_in) for explained in fits]
    asked = {item.block.name for item in evidence}
    blocks = [block for block in gathered.named if block.name in asked]
    given = [kept_evidence(gathered.with_block(item.block).bases, blocks, gathered.noise) for item in evidence]
    spans = _spans(gathered)
    possible = [item for item in evidence if not why_not_physical(gathered, item)]
    found: list[Candidate] = []
    for index, item in enumerate(evidence):
        alike = _alike(item, spans)
        rivals = {*_rivals(index, evidence, afters, given[index]), *_too_near(item, possible, alike)}
        candidate = _candidate(gathered, item, (before, afters[index]), rivals, max(alike.values(), default=0.0))
        if candidate.score >= VERY_STRONG and candidate.physical and not is_confirmed(candidate):
            # a shape of the model may have taken what it explains, as a Stribeck curve of a high speed takes drag
            explained = fit_effects(fit, [*fit.names, item.block.name], sliding)
            afters[index] = _held_out(explained, gathered.show_in)
            candidate = as_in_the_ladder(candidate, fit, explained, gathered.show_in)
        found.append(candidate)
    confirmed = [index for index, one in enumerate(found) if is_confirmed(one)]
    best = confirmed[0] if confirmed else None
    for index in confirmed[1:]:
        enough = evidence[index].noncentrality >= FORMULA_SHARE * evidence[confirmed[0]].noncentrality
        if best is not None and enough and predicts_better(afters[index], afters[best]):
            best = index
    order = sorted(range(len(found)), key=lambda one: (one != best, one not in confirmed))  # stable: by score
    return [found[index] for index in order]


def explains(kept: dict[str, float], other: Evidence) -> bool:
    """Whether another effect loses most of its evidence, of which so much is kept once this one is in the model."""
    return kept.get(other.block.name, 0.0) < EXPLAINED_BY_RIVAL * other.noncentrality


def as_in_the_ladder(candidate: Candidate, fit: Fit, explained: Fit, show_in: MotionRows) -> Candidate:
    """The candidate with the held-out error of the model that it is added to: there, all shapes are found anew."""
    before, after = (_held_out(model, show_in) for model in (fit, explained))
    return replace(candidate, after=after.relative, gain=held_out_gain(before, after), errors=after)


def _held_out(fit: Fit, show_in: MotionRows) -> HeldOut:
    return held_out(fit, show_in if fit.dataset.rows == "sliding" else fit.dataset.rows)


def _spans(gathered: Candidates) -> list[tuple[str, FloatArray, bool]]:
    """What each block can explain beyond its base: the effect's name, an orthonormal basis (n, rank), and whether it
    has one column, of no coefficient below zero."""
    quantity = gathered.fit.dataset.effort_definition.quantity
    return [
        (
            block.name,
            new_directions(gathered.bases[block.base], block),
            [low for low, _ in effect_named(block.name).ranges_in(quantity)] == [0.0],
        )
        for block in gathered.named
    ]


def _alike(item: Evidence, spans: list[tuple[str, FloatArray, bool]]) -> dict[str, float]:
    """How much of what an effect explains every other one could explain, as a correlation: of a sign that it can have.

    What grows faster than the speed and what grows more slowly are told apart by nothing else.
    """
    alike: dict[str, float] = {}
    for name, basis, positive in spans:
        if name != item.block.name:
            shares = basis.T @ item.direction
            found = min(float(np.linalg.norm(np.maximum(shares, 0.0) if positive else shares)), 1.0)
            alike[name] = max(alike.get(name, 0.0), found)
    return alike


def _too_near(item: Evidence, evidence: list[Evidence], alike: dict[str, float]) -> set[str]:
    """Effects that speak for themselves, and that stand too near for a name to be given without them."""
    paying = (other.block.name for other in evidence if other is not item and other.score > 0.0)
    return {name for name in paying if detectability(item, alike.get(name, 0.0)) < NAMED_ALONE}


def detectability(item: Evidence, correlation: float) -> float:
    """d' of an effect from another one that could explain so much of what it explains, as a correlation."""
    return float(np.sqrt(item.noncentrality * max(0.0, 1.0 - correlation**2)))


def _rivals(index: int, evidence: list[Evidence], afters: list[HeldOut], left: dict[str, float]) -> set[str]:
    """Effects that the trials cannot tell from one candidate: it explains their evidence, and they predict as well."""
    return {
        other.block.name
        for other, after in zip(evidence, afters, strict=True)
        if other is not evidence[index] and explains(left, other) and not predicts_better(afters[index], after)
    }


def _candidate(
    gathered: Candidates, item: Evidence, errors: tuple[HeldOut, HeldOut], rivals: set[str], nearest: float
) -> Candidate:
    before, after = errors
    return Candidate(
        effect=effect_named(item.block.name),
        shape=item.block.shape,
        score=item.score,
        p_value=item.p_value,
        detectability=detectability(item, nearest),
        rivals=tuple(sorted(rivals)),
        before=before.relative,
        after=after.relative,
        gain=held_out_gain(before, after),
        picture=picture_of(gathered, item),
        errors=after,
        impossible=why_not_physical(gathered, item),
        badge=badge_of(gathered, item),
        rows=gathered.show_in,
    )
