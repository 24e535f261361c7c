"""Examine candidates: refit with each, measure the gain on held-out rows, find its rivals."""

from dataclasses import replace

import numpy as np

from compensator.lab import progress
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.physical import is_physical
from compensator.lab.diagnosis.pictures import picture_of
from compensator.lab.effects.catalogue import catalogue, effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.model.fit import fit_sliding, with_effect
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.model.weights import determination
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, Screening, kept_evidence, new_directions

TIE = 2.0  # of scores: barely worth a mention (Kass, Raftery 1995)
ALIKE = 0.95  # correlation of what two effects explain


def best_shapes(gathered: Candidates, screening: Screening) -> list[Evidence]:
    """The best shape of every effect, best effect first; of those that tie, the one that the catalogue has first."""
    best_of: dict[str, Evidence] = {}
    for evidence in screening.evidence:  # the best shape first
        best_of.setdefault(evidence.block.name, evidence)
    ranked = sorted(best_of.values(), key=lambda item: -item.score)
    order = list(catalogue())
    best = next((item for item in ranked if is_physical(gathered, item)), None)
    tied = [item for item in ranked if best is not None and _ties(item, best)]
    plainest = min(tied, key=lambda item: order.index(item.block.name), default=None)
    return ranked if plainest is None else [plainest, *(item for item in ranked if item is not plainest)]


def _ties(item: Evidence, best: Evidence) -> bool:
    """Whether two effects explain the same, and about as well: then the rows cannot choose between them."""
    alike = abs(float(item.direction @ best.direction)) >= ALIKE
    return alike and item.score >= best.score - TIE


EXPLAINED_BY_RIVAL = 0.5  # share of its evidence that a rival loses once the best effect is in the model
FORMULA_SHARE = 0.6  # of a free curve's evidence, or of the best formula's: one that reaches less is not the right one
SHARE_NEAR_REVERSALS = 0.9  # the same there, where every effect has a little of what any other explains
NAMED_ALONE = 3.0  # d' below which a name given alone would be wrong once in four (docs/explanation/diagnosis.md)


def examine(fit: Fit, gathered: Candidates, evidence: list[Evidence]) -> list[Candidate]:
    """Candidates for the best shape of each effect: the answer, others that are confirmed, the rest; each by score."""
    before = _held_out(fit, gathered.show_in)
    sliding = None if gathered.show_in == "sliding" else fit_sliding(fit.dataset, fit.names, fit.training, fit.shapes)
    fits = [with_effect(fit, item.block.name, item.block.shape, sliding) for item in progress.each(evidence)]
    afters = [_held_out(explained, gathered.show_in) for explained in fits]
    given = [_evidence_given(gathered, item) for item in evidence]
    spans = _spans(gathered)
    candidates = []
    for index, (item, after) in enumerate(zip(evidence, afters, strict=True)):
        alike = _alike(item, spans)
        possible = [other for other in evidence if is_physical(gathered, other)]
        rivals = {*_rivals(index, evidence, afters, given[index]), *_too_near(item, possible, alike)}
        candidates.append(_candidate(gathered, item, (before, after), rivals, max(alike.values(), default=0.0)))
    confirmed = [index for index, candidate in enumerate(candidates) if is_confirmed(candidate)]
    first = _best_predictor(confirmed, evidence, afters, given)
    # stable: by score within each kind
    order = sorted(range(len(candidates)), key=lambda index: (index != first, index not in confirmed))
    return [candidates[index] for index in order]


def _best_predictor(
    confirmed: list[int], evidence: list[Evidence], afters: list[HeldOut], given: list[dict[str, float]]
) -> int | None:
    """Which of the confirmed candidates, best score first, is the answer; None where none is confirmed.

    Of two that explain the same, the one that predicts other trials better for sure: the score is had beside all that
    formulas leave open, which may be most of what tells the two apart.
    """
    first = confirmed[0] if confirmed else None
    for other in confirmed[1:]:
        assert first is not None
        if _explains(given[other], evidence[first]) and predicts_better(afters[other], afters[first]):
            first = other
    return first


def _explains(kept: dict[str, float], other: Evidence) -> bool:
    """Whether another effect loses most of its evidence, of which so much is kept once this one is in the model."""
    return kept.get(other.block.name, 0.0) < EXPLAINED_BY_RIVAL * other.noncentrality


def as_in_the_ladder(candidate: Candidate, fit: Fit, explained: Fit, show_in: MotionRows) -> Candidate:
    """The candidate with the held-out error of the model that it is added to: there, all shapes are found anew."""
    before, after = (_held_out(model, show_in) for model in (fit, explained))
    return replace(candidate, after=after.relative, gain=held_out_gain(before, after))


def _held_out(fit: Fit, show_in: MotionRows) -> HeldOut:
    rows = show_in if fit.dataset.rows == "sliding" else fit.dataset.rows
    # near reversals a part of the whole error is asked for, since every chain leaves a little there
    return held_out(fit, rows, determination(fit) if show_in == "sliding" else None)


def share_of(show_in: MotionRows) -> float:
    """Of the evidence of the likeliest effect: what explains less is the shadow of something else."""
    return FORMULA_SHARE if show_in == "sliding" else SHARE_NEAR_REVERSALS


def _evidence_given(gathered: Candidates, item: Evidence) -> dict[str, float]:
    """Evidence that every effect keeps once this one is in the model."""
    return kept_evidence(gathered.with_block(item.block).bases, gathered.named, gathered.noise)


def _spans(gathered: Candidates) -> list[tuple[str, FloatArray]]:
    """What each block can explain beyond its base: the effect's name and an orthonormal basis (n, rank)."""
    return [(block.name, new_directions(gathered.bases[block.base], block)) for block in gathered.named]


def _alike(item: Evidence, spans: list[tuple[str, FloatArray]]) -> dict[str, float]:
    """How much of what an effect explains every other one could explain, as a correlation."""
    alike: dict[str, float] = {}
    for name, basis in spans:
        if name != item.block.name:
            found = min(float(np.linalg.norm(basis.T @ item.direction)), 1.0)
            alike[name] = max(alike.get(name, 0.0), found)
    return alike


def _too_near(item: Evidence, evidence: list[Evidence], alike: dict[str, float]) -> set[str]:
    """Effects that speak for themselves, and that stand too near for a name to be given without them."""
    paying = (other.block.name for other in evidence if other is not item and other.score > 0.0)
    return {name for name in paying if _detectability(item, alike.get(name, 0.0)) < NAMED_ALONE}


def _detectability(item: Evidence, correlation: float) -> float:
    return float(np.sqrt(item.noncentrality * max(0.0, 1.0 - correlation**2)))


def _rivals(index: int, evidence: list[Evidence], afters: list[HeldOut], left: dict[str, float]) -> set[str]:
    """Effects that the trials cannot tell from one candidate: it explains their evidence, and they predict as well."""
    own = evidence[index]
    found = set()
    for other, after in zip(evidence, afters, strict=True):
        if other is not own and _explains(left, other) and not predicts_better(afters[index], after):
            found.add(other.block.name)
    return found


def _candidate(
    gathered: Candidates, item: Evidence, errors: tuple[HeldOut, HeldOut], rivals: set[str], nearest: float
) -> Candidate:
    before, after = errors
    return Candidate(
        effect=effect_named(item.block.name),
        shape=item.block.shape,
        score=item.score,
        p_value=item.p_value,
        detectability=_detectability(item, nearest),
        rivals=tuple(sorted(rivals)),
        before=before.relative,
        after=after.relative,
        gain=held_out_gain(before, after),
        physical=is_physical(gathered, item),
        picture=picture_of(gathered, item),
        rows=gathered.show_in,
    )
