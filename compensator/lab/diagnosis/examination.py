"""Examine candidates: refit with each, measure the gain on held-out rows, find its rivals."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from compensator.lab import progress
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.physical import POSSIBLE, why_impossible
from compensator.lab.diagnosis.pictures import picture_of
from compensator.lab.effects.catalogue import candidates, effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.model.fit import fit_effects, fit_model, fit_sliding
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, Screening, among_all, kept_evidence, new_directions

EXPLAINED_BY_RIVAL = 0.5  # share of its evidence that a rival loses once the best effect is in the model
FORMULA_SHARE = 0.6  # of a free curve's evidence, or of the best formula's: one that reaches less is not the right one
ALL = 1.0 - 1e-9  # of a direction, but for rounding
NAMED_ALONE = 3.0  # d' below which a name given alone would be wrong once in four (docs/explanation/diagnosis.md)


def best_shapes(evidence: list[Evidence]) -> list[Evidence]:
    """The best shape of every effect, best effect first, of evidence in that order."""
    own: dict[str, Evidence] = {}
    for item in evidence:
        own.setdefault(item.block.name, item)
    return list(own.values())


def examine(fit: Fit, gathered: Candidates, screening: Screening, screened: list[Evidence]) -> list[Candidate]:
    """Candidates in the model that would be had, all shapes found anew there; confirmed first, each by score.

    Args:
        fit: the model.
        gathered: what it may be missing, and the noise.
        screening: of all that was tried.
        screened: of it, evidence for the best scanned shape of each effect.
    """
    before = _held_out(fit, gathered.show_in)
    sliding = None if gathered.show_in == "sliding" else fit_sliding(fit.dataset, fit.names, fit.training, fit.shapes)
    fits = {item.block.name: _fitted(fit, item, sliding) for item in progress.each(screened)}
    evidence = _as_fitted(gathered, screened, fits)
    afters = [_held_out(fits[item.block.name], gathered.show_in) for item in evidence]
    blocks = [block for block in gathered.named if block.name in fits]
    given = [kept_evidence(gathered.with_block(item.block).bases, blocks) for item in evidence]
    spans = _spans(gathered)
    impossible = [why_impossible(fits[item.block.name], item.block.name) for item in evidence]
    possible = [item for item, why in zip(evidence, impossible, strict=True) if why == POSSIBLE]
    found: list[Candidate] = []
    for index, item in enumerate(evidence):
        alike = _alike(item, spans)
        rivals = _rivals(index, evidence, afters, given[index]) & alike.keys()
        rivals |= _too_near(item, possible, alike) | _hidden(fit, item.block.name)
        found.append(
            Candidate(
                effect=effect_named(item.block.name),
                shape=item.block.shape,
                score=item.score,
                p_value=among_all(screening.chance(item.p_value)),
                detectability=detectability(item, max(alike.values(), default=0.0)),
                rivals=tuple(sorted(rivals)),
                before=before.relative,
                after=afters[index].relative,
                gain=held_out_gain(before, afters[index]),
                picture=picture_of(gathered, item),
                evidence=item,
                explained=fits[item.block.name],
                impossible=impossible[index].words,
                badge=impossible[index].badge,
                rows=gathered.show_in,
            )
        )
    return sorted(found, key=lambda one: not is_confirmed(one))  # stable: by score


def _fitted(fit: Fit, item: Evidence, sliding: Fit | None) -> Fit:
    """The model with one more effect, all shapes found anew; as they are where the evidence does not pay for it."""
    names = [*fit.names, item.block.name]
    if item.score > 0.0:
        return fit_effects(fit, names, sliding)
    return fit_model(fit.dataset, names, fit.training, {**fit.shapes, item.block.name: item.block.shape}, sliding)


def _as_fitted(gathered: Candidates, screened: list[Evidence], fits: Mapping[str, Fit]) -> list[Evidence]:
    """Evidence for effects as they are in their models, best score first; as screened where that adds nothing."""
    blocks = [_as_in(gathered, item.block, fits[item.block.name]) for item in screened]
    found = {one.block.name: one for one in gathered.screened(blocks).evidence}
    return sorted((found.get(item.block.name, item) for item in screened), key=lambda one: -one.score)


def _as_in(gathered: Candidates, block: Block, fit: Fit) -> Block:
    """An effect as it is in its model: its columns, or, where it moves what was measured in time, what it explains."""
    effect, shape = effect_named(block.name), fit.shapes[block.name]
    if effect.driver == "effort_rate":
        columns = (gathered.fit.residual - fit.residual)[:, None]
    else:
        columns = gathered.fit.dataset.unchecked_columns(effect, [shape])[0]
    return replace(block, columns=gathered.tested(columns), shape=shape)


def explains(kept: dict[str, float], other: Evidence) -> bool:
    """Whether another effect loses most of its evidence, of which so much is kept once this one is in the model."""
    return kept.get(other.block.name, 0.0) < EXPLAINED_BY_RIVAL * other.noncentrality


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

    What grows faster than the speed and what grows more slowly are told apart by nothing else. One that has all of the
    effect's columns, and more, is no rival: whether more is needed, the score says, which has a price for it.
    """
    alike: dict[str, float] = {}
    own = item.block.columns.shape[1]
    for name, basis, positive in spans:
        contains = basis.shape[1] > own and np.linalg.norm(basis.T @ item.direction) >= ALL
        if name != item.block.name and not contains:
            shares = basis.T @ item.direction
            found = min(float(np.linalg.norm(np.maximum(shares, 0.0) if positive else shares)), 1.0)
            alike[name] = max(alike.get(name, 0.0), found)
    return alike


def _too_near(item: Evidence, evidence: list[Evidence], alike: dict[str, float]) -> set[str]:
    """Effects that speak for themselves, and that stand too near for a name to be given without them."""
    paying = (other.block.name for other in evidence if other is not item and other.score > 0.0)
    return {name for name in paying if detectability(item, alike.get(name, 0.0)) < NAMED_ALONE}


def _hidden(fit: Fit, name: str) -> set[str]:
    """Effects that a free scale of the model hides, which no trial can tell from one of that name."""
    return {
        one.name
        for one in candidates(fit.names, fit.dataset.facts)
        if name in one.confused_with and any(scale in fit.names for scale in one.hidden_by)
    }


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
