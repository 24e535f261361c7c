"""Examine candidates: refit with each, measure the gain on held-out rows, find its rivals."""

from dataclasses import replace

import numpy as np

from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.pictures import picture_of
from compensator.lab.diagnosis.second_look import beside_open
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import EffectRows, MotionRows, Shape
from compensator.lab.model.fit import Fit, fit_model
from compensator.lab.model.gain import Gain, chance_not_worse, held_out_gain
from compensator.lab.model.validation import HeldOut, held_out
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import Evidence, kept_evidence, new_directions, score_of

SIGNIFICANT = 0.01
EXPLAINED_BY_RIVAL = 0.5  # share of its evidence that a rival loses once the best effect is in the model
LEAST_GAIN = 0.005  # a smaller fall of the held-out error is of no use, however sure it is
LEAST_GAIN_NEAR_REVERSALS = 0.05  # where every measuring chain leaves a little that looks like memory
LEAST_EXPLAINED = 5e-4  # of the effort, root mean square, on held-out rows: less than any sensor is linear
NOT_WORSE = 0.10  # one-sided
NAMED_ALONE = 3.0  # d' below which a name given alone would be wrong once in four (docs/diagnosis.md)
UNSURE = 2.0  # standard errors: a coefficient so near to a bound may lie on either side of it
ROUNDING = 1e-6  # of a shape that was looked for by its logarithm
VERY_STRONG = 10.0  # of a score, twice a log Bayes factor (Kass, Raftery 1995)


def examine(fit: Fit, gathered: Candidates, evidence: list[Evidence]) -> list[Candidate]:
    """Candidates for the best shape of each effect, those that are confirmed first, each kind by score."""
    before = _held_out(fit, gathered.show_in)
    afters = [_held_out(with_effect(fit, item.block.name, _shape(item)), gathered.show_in) for item in evidence]
    given = [_evidence_given(gathered, item) for item in evidence]
    spans = _spans(gathered)
    candidates = []
    for index, (item, after) in enumerate(zip(evidence, afters, strict=True)):
        alike = _alike(item, spans)
        rivals = {*_rivals(index, evidence, afters, given[index]), *_too_near(item, evidence, alike)}
        candidates.append(_candidate(gathered, item, (before, after), rivals, max(alike.values(), default=0.0)))
    candidates = _looked_at_again(gathered, candidates)
    return sorted(candidates, key=lambda candidate: not is_confirmed(candidate))  # stable: by score within each kind


def as_in_the_ladder(candidate: Candidate, fit: Fit, explained: Fit, show_in: MotionRows) -> Candidate:
    """The candidate with the held-out error of the model that it is added to: there, all shapes are found anew."""
    before, after = (_held_out(model, show_in) for model in (fit, explained))
    return replace(candidate, after=after.relative, gain=held_out_gain(before, after))


def _held_out(fit: Fit, show_in: MotionRows) -> HeldOut:
    rows = show_in if fit.dataset.rows == "sliding" else fit.dataset.rows
    # near reversals a part of the whole error is asked for, since every chain leaves a little there
    return held_out(fit, rows, fit.determination if show_in == "sliding" else None)


def _held_out_sliding(fit: Fit) -> HeldOut:
    return _held_out(fit, "sliding")


def _looked_at_again(gathered: Candidates, candidates: list[Candidate]) -> list[Candidate]:
    """The candidates; very strong ones whose gain other formulas may hide, with that beside what these leave open.

    Where one is confirmed as it is, no other is looked at again.
    """
    if gathered.show_in != "sliding" or any(is_confirmed(one) for one in candidates):
        return candidates
    hidden = [one.effect.name for one in candidates if _may_be_hidden(one)]
    found = beside_open(gathered.fit, hidden, _held_out_sliding)
    return [replace(one, beside_open=found.get(one.effect.name)) for one in candidates]


def _may_be_hidden(candidate: Candidate) -> bool:
    """Whether all but the held-out gain speaks for a candidate, and that very strongly."""
    very_strong = candidate.score >= VERY_STRONG and candidate.p_value <= SIGNIFICANT
    return very_strong and candidate.physical and not is_sure(candidate)


def is_confirmed(candidate: Candidate) -> bool:
    """Whether the evidence pays for its parameters, and neither it nor the gain on held-out rows is luck.

    What explains nothing unless it is larger, smaller, or of the other sign than it can be, is the shadow of something
    else. Neither flips of signs nor trials drawn again can be sure where a few stretches or trials hold most of the
    evidence, as those at the highest speed do of drag: there a very strong score stands without them, if the error
    falls at all; near reversals, where every chain leaves a little, if it falls as much as is asked for even without
    the trial that gains most.
    """
    return is_sure(candidate) and candidate.physical


def is_sure(candidate: Candidate) -> bool:
    """Whether a candidate is confirmed but for the size and sign that it would need."""
    strong = candidate.score >= VERY_STRONG
    no_luck = candidate.p_value <= SIGNIFICANT or strong
    before, gain = candidate.before, candidate.gain
    if candidate.beside_open is not None:
        before, gain = candidate.beside_open.before, candidate.beside_open.gain
    falls = before**2 * (1.0 - (1.0 - gain.value) ** 2) >= LEAST_EXPLAINED**2
    least = LEAST_GAIN if candidate.effect.rows == "sliding" else LEAST_GAIN_NEAR_REVERSALS
    helps = gain.value >= least and falls and (gain.low > 0.0 or (strong and _lasts(gain, candidate.rows)))
    return candidate.score > 0.0 and no_luck and helps


def _lasts(gain: Gain, rows: EffectRows) -> bool:
    """Whether a gain that trials drawn again are not sure of is nevertheless one of more than a single trial."""
    if rows == "moving":
        return gain.without_best >= LEAST_GAIN_NEAR_REVERSALS
    return rows == "sliding"


def with_effect(fit: Fit, name: str, shape: Shape) -> Fit:
    """The model and one more effect of a given shape, refitted at the shapes already found."""
    return fit_model(fit.dataset, [*fit.names, name], fit.training, {**fit.shapes, name: shape})


def _shape(item: Evidence) -> Shape:
    return item.block.key if isinstance(item.block.key, tuple) else ()


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
        explained = left.get(other.block.name, 0.0) < EXPLAINED_BY_RIVAL * other.noncentrality
        if other is not own and explained and chance_not_worse(after, afters[index]) > NOT_WORSE:
            found.add(other.block.name)
    return found


def _candidate(
    gathered: Candidates, item: Evidence, errors: tuple[HeldOut, HeldOut], rivals: set[str], nearest: float
) -> Candidate:
    before, after = errors
    return Candidate(
        effect=effect_named(item.block.name),
        shape=_shape(item),
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


def is_physical(gathered: Candidates, item: Evidence) -> bool:
    """Whether size and shape are such that it can be the effect."""
    return is_possible(gathered, item) and not is_past_scan(gathered, item)


def is_possible(gathered: Candidates, item: Evidence) -> bool:
    """Whether the freely fitted coefficients are within bounds, and as large as what they stand in the place of.

    What the measuring chain makes near reversals is nothing physical, and what the owner tells of is not missing.
    """
    fits = is_within_bounds(gathered, item) and not is_too_small(gathered, item)
    if effect_named(item.block.name).told(gathered.fit.dataset.facts, _shape(item)):
        return False
    return fits and not is_made_by_chain(gathered, item)


def is_made_by_chain(gathered: Candidates, item: Evidence) -> bool:
    """Whether an effect near reversals has no very strong evidence beside the chain's columns that it stands in for.

    Without these, all that a sign leaves that is smoothed or late would count for the effect. In steady sliding that
    is not asked: what stands for the chain is there what is missing, as a Stribeck curve of a low speed is.
    """
    if gathered.show_in != "moving" or item.block.base == WITH_CHAIN:
        return False
    return score_of(gathered.bases, replace(item.block, base=WITH_CHAIN), gathered.noise) < VERY_STRONG


def is_within_bounds(gathered: Candidates, item: Evidence) -> bool:
    """Whether the freely fitted coefficients lie within the effect's bounds, as far as the rows can tell."""
    ranges = effect_named(item.block.name).ranges_in(gathered.fit.dataset.effort_definition.quantity)
    found = _coefficients(gathered, item)
    unsure = UNSURE * _standard_error(item, found)
    return all(low - unsure <= c <= high + unsure for (low, high), c in zip(ranges, found, strict=True))


def is_too_small(gathered: Candidates, item: Evidence) -> bool:
    """Whether an effect that stands in the place of dry friction is but a part of it."""
    least = effect_named(item.block.name).least_of_friction * gathered.fit.dry_friction
    return least > 0.0 and bool(np.all(_coefficients(gathered, item) < least))


def is_past_scan(gathered: Candidates, item: Evidence) -> bool:
    """Whether the shape lies at an upper end of a scan of all that the effect can be: what fits there goes on."""
    effect, shape = effect_named(item.block.name), _shape(item)
    if not effect.ends_within_scan or not shape:
        return False
    ends = np.max(effect.shapes(gathered.fit.dataset.trials[0].motion), axis=0)
    return bool(np.any(np.array(shape) >= (1.0 - ROUNDING) * ends))


def _coefficients(gathered: Candidates, item: Evidence) -> FloatArray:
    """Freely fitted, on top of the model, shape (k,)."""
    base = gathered.bases[item.block.base]
    columns = item.block.columns - base.basis @ (base.basis.T @ item.block.columns)
    found: FloatArray = np.linalg.lstsq(columns, base.residual, rcond=1e-6)[0].astype(np.float64)
    return found


def _standard_error(item: Evidence, coefficients: FloatArray) -> float:
    """Of a coefficient that stands alone: its evidence is the square of how many of them it is; 0 beside others."""
    alone = len(coefficients) == 1 and item.noncentrality > 0.0
    return float(abs(coefficients[0]) / np.sqrt(item.noncentrality)) if alone else 0.0
