"""Evidence for each candidate effect, from one fit of the base model.

Three numbers per candidate, never mixed up: a likelihood score for naming, a p-value that stays honest under
autocorrelation for detection, and (elsewhere) the held-out gain. See docs/explanation/diagnosis.md.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import chdtrc, erfc

from compensator.lab.chance import LEAST_STATED, SIGN_FLIPS
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.noise import Noise, strength

SCREENINGS = 5  # of one diagnosis: steady effects, free curves, effects with memory, breakaway, the measuring chain
VERY_STRONG = 10.0  # of a score, twice a log Bayes factor (Kass, Raftery 1995)


@dataclass(frozen=True)
class Evidence:
    """What the rows say for one block.

    Attributes:
        block: the candidate.
        score: log-likelihood gain in units of 2 ln L, less the price of its parameters and shapes; > 0 speaks for it.
        noncentrality: the gain itself, over the noise's power and its autocorrelation.
        p_value: of this block alone.
        direction: the block's own contribution after projection, unit norm, shape (n,).
    """

    block: Block
    score: float
    noncentrality: float
    p_value: float
    direction: FloatArray


@dataclass(frozen=True)
class Screening:
    """Evidence for all blocks, best score first, and the chance that the best p-value is luck over all of them.

    Attributes:
        evidence: of all blocks.
        p_value: the chance that luck alone brings the own p-value of any block screened down to the least of them.
        chance: the same of another p-value than the least; None where p-values of blocks are not of one measure, as
            those by flips of few stretches are not.
    """

    evidence: list[Evidence]
    p_value: float
    chance: Callable[[float], float] | None = None


def screen(
    bases: Sequence[Base], blocks: Sequence[Block], stretch: IntArray, seed: int = 0, noise: Noise | None = None
) -> Screening:
    """Judge every block by flips of signs.

    The joint null is had by flipping the signs of whole stretches of the score (wild bootstrap): shape scanning and
    the number of candidates are inside the maximum, so that no further correction is due.

    Args:
        bases: what blocks are judged on top of.
        blocks: candidates.
        stretch: independent stretch of each row, shape (n,).
        seed: of the flips.
        noise: of the rows, for scores to be held against those of `screen_against_noise`.
    """
    labels, signs = _flipped(stretch, seed)
    evidence, lowest = [], np.ones(len(signs))
    inflation = max(inflation_of(base.residual) for base in bases)
    for block in blocks:
        base = bases[block.base]
        directions = new_directions(base, block)
        if not directions.shape[1]:
            continue
        p_values = _robust_p(_sums(base, directions, labels), signs)
        lowest = np.minimum(lowest, p_values)
        gain = _gain_by(noise, base, directions, inflation)
        score = gain - _price(block, directions, inflation)
        evidence.append(Evidence(block, score, gain, float(p_values[0]), _contribution(base, directions)))
    p_value = float(np.mean(lowest <= lowest[0] * (1.0 + 1e-9)))
    return Screening(sorted(evidence, key=lambda item: -item.score), p_value)


def screen_against_noise(bases: Sequence[Base], blocks: Sequence[Block], noise: Noise) -> Screening:
    """Judge every block against noise that is known.

    Where a few stretches hold all of an effect, as those at the highest speed do of drag, their flips can never say
    how sure it is; the noise of all rows can. The null is Gaussian, with the noise's own autocovariance.

    Args:
        bases: what blocks are judged on top of.
        blocks: candidates.
        noise: that a complete model would leave.
    """
    found = [(block, bases[block.base], new_directions(bases[block.base], block)) for block in blocks]
    found = [(block, base, directions) for block, base, directions in found if directions.shape[1]]
    if not found:
        return Screening([], 1.0)
    ends = np.cumsum([0, *(directions.shape[1] for _, _, directions in found)])
    places = [slice(int(a), int(b)) for a, b in pairwise(ends)]
    covariance = noise.covariance(np.concatenate([directions for _, _, directions in found], axis=1))
    inflation = max(inflation_of(base.residual) for base in bases)
    evidence = []
    for (block, base, directions), own in zip(found, places, strict=True):
        share = directions.T @ base.residual
        size = strength(share, covariance[own, own])
        known = _compressed(size, len(base.residual) / inflation)
        gain = _likelihood(base, share, inflation) if noise.outweighed else known
        score = gain - _price(block, directions, inflation)
        direction = _contribution(base, directions)
        evidence.append(Evidence(block, score, gain, noise.chance(size, len(share)), direction))
    least = min(item.p_value for item in evidence)
    chance = noise.joint_chances(covariance, places)
    return Screening(sorted(evidence, key=lambda item: -item.score), chance(least), chance)


def screen_events(
    bases: Sequence[Base], blocks: Sequence[Block], unit: IntArray, seed: int = 0, model: int = 0
) -> Screening:
    """Judge every block on rows that are events: few, weighted to one variance, independent between units.

    The null is had by flipping the signs of whole units of the residual (wild bootstrap); the score itself is the
    statistic. Studentised by units, as for rows in motion, a contrast between a few of them could never be told.
    Arguments as `screen`; `unit` in place of its stretches. A block of another base than the first would stand in the
    place of what the model has beyond that base, and must explain more than that; `model` is the base that holds what
    the model itself has, within its bounds.
    """
    labels, signs = _flipped(unit, seed)
    evidence, highest = [], np.full(len(signs), -np.inf)
    inflation = max(inflation_of(base.residual) for base in bases)
    for block in blocks:
        base = bases[block.base]
        directions = new_directions(base, block)
        count, rank = directions.shape
        if rank == 0:
            continue
        if block.base == 0:
            shares = signs @ _sums(base, directions, labels)
            gains = np.array([_likelihood(base, share, inflation) for share in shares])
        else:
            gains = _gains_in_place(bases[model], base, directions, signs[:, labels]) / inflation
        replaced = max(bases[model].basis.shape[1] - base.basis.shape[1], 0)
        scores = gains - (rank - replaced) * np.log(count / inflation) - 2.0 * np.log(block.scanned)
        highest = np.maximum(highest, scores)
        gain = max(float(gains[0]), 0.0)
        evidence.append(Evidence(block, float(scores[0]), gain, _rank(scores), _contribution(base, directions)))
    return Screening(sorted(evidence, key=lambda item: -item.score), _rank(highest))


def _gains_in_place(whole: Base, part: Base, directions: FloatArray, signs: FloatArray) -> FloatArray:
    """Gain of 2 ln L, per independent row, from directions (n, rank) in the place of what `whole` has beyond `part`.

    For each row of signs (f, n) of the whole base's residual, its own share of the effort as it is: what stands in the
    model already is no evidence for what would replace it (Cox 1961).
    """
    flipped = signs * whole.residual
    before = np.sum(flipped**2, axis=1) - np.sum((flipped @ whole.basis) ** 2, axis=1)
    left = part.residual - whole.residual + flipped - (flipped @ part.basis) @ part.basis.T
    after = np.sum(left**2, axis=1) - np.sum((left @ directions) ** 2, axis=1)
    tiny = np.finfo(float).tiny
    gains: FloatArray = len(whole.residual) * np.log(np.maximum(before, tiny) / np.maximum(after, tiny))
    return gains


def _rank(statistics: FloatArray) -> float:
    """The share of flips, with what was measured among them, that reach what was measured (the first)."""
    return float(np.mean(statistics >= statistics[0] - 1e-9 * abs(statistics[0])))


def among_all(p_value: float) -> float:
    """The chance of so much evidence in any of a diagnosis's screenings (Bonferroni)."""
    return min(1.0, SCREENINGS * p_value)


def least_p_value(stretches: int) -> float:
    """The lowest p of a diagnosis on so many stretches: one flip of signs in 2^(stretches - 1) changes nothing."""
    return among_all(max(0.5 ** (stretches - 1), LEAST_STATED))


def kept_evidence(bases: Sequence[Base], blocks: Sequence[Block], noise: Noise | None = None) -> dict[str, float]:
    """The greatest noncentrality of each name's blocks on top of the bases; 0 where nothing new is left."""
    inflation = max(inflation_of(base.residual) for base in bases)
    each = [(block.name, bases[block.base], new_directions(bases[block.base], block)) for block in blocks]
    known = None if noise is None or noise.outweighed else _covariances(noise, [own for _, _, own in each])
    kept: dict[str, float] = {}
    for index, (name, base, directions) in enumerate(each):
        gain = _gain(base, directions, inflation, None if known is None else known[index])
        kept[name] = max(kept.get(name, 0.0), gain)
    return kept


def score_of(bases: Sequence[Base], block: Block, noise: Noise | None = None) -> float:
    """The score of one block on top of its base; that of no gain where nothing new is left."""
    inflation = max(inflation_of(base.residual) for base in bases)
    directions = new_directions(bases[block.base], block)
    return _gain_by(noise, bases[block.base], directions, inflation) - _price(block, directions, inflation)


def most_likely(bases: Sequence[Base], blocks: Sequence[Block]) -> Block | None:
    """The block with the best score by likelihood alone; None where no score is above zero."""
    inflation = max(inflation_of(base.residual) for base in bases)
    best, highest = None, 0.0
    for block in blocks:
        directions = new_directions(bases[block.base], block)
        score = _gain(bases[block.base], directions, inflation, None) - _price(block, directions, inflation)
        best, highest = (block, score) if score > highest else (best, highest)
    return best


def _gain_by(noise: Noise | None, base: Base, directions: FloatArray, inflation: float) -> float:
    """As `_gain`, against a noise where it is known, and tells formulas apart."""
    none = noise is None or noise.outweighed or not directions.shape[1]
    known = None if noise is None or none else noise.covariance(directions)
    return _gain(base, directions, inflation, known)


def _gain(base: Base, directions: FloatArray, inflation: float, covariance: FloatArray | None) -> float:
    """2 ln L gained by directions (n, rank).

    Against what noise puts into them (rank, rank); None: by the residual's lag-one correlation.
    """
    share = directions.T @ base.residual
    if covariance is None or not len(share):
        return _likelihood(base, share, inflation)
    return _compressed(strength(share, covariance), len(base.residual) / inflation)


def _covariances(noise: Noise, each: Sequence[FloatArray]) -> list[FloatArray]:
    """Of what noise puts into directions (n, rank) of many blocks: one pass through the trials for all of them."""
    ends = np.cumsum([0, *(directions.shape[1] for directions in each)])
    if not ends[-1]:
        return [np.zeros((0, 0))] * len(each)
    whole = noise.covariance(np.concatenate(each, axis=1))
    return [whole[a:b, a:b] for a, b in pairwise(ends)]


def _compressed(size: float, independent: float) -> float:
    """2 ln L gained, where the noise is learnt, too: far beyond it, what else a block misses counts as noise."""
    return float(independent * np.log1p(size / independent))


def _price(block: Block, directions: FloatArray, inflation: float) -> float:
    count, rank = directions.shape
    return float(rank * np.log(count / inflation) + 2.0 * np.log(block.scanned))


def _sums(base: Base, directions: FloatArray, labels: IntArray) -> FloatArray:
    """What each stretch (of each row in `labels`) has of the score of directions (n, rank), (stretches, rank)."""
    sums = np.zeros((int(labels.max()) + 1, directions.shape[1]))
    np.add.at(sums, labels, directions * base.residual[:, None])
    return sums


def _contribution(base: Base, directions: FloatArray) -> FloatArray:
    """What directions (n, rank) explain of a base's residual, unit norm, shape (n,); zeros where that is nothing."""
    own: FloatArray = directions @ (directions.T @ base.residual)
    return own / (float(np.linalg.norm(own)) or 1.0)


def new_directions(base: Base, block: Block) -> FloatArray:
    """Orthonormal basis of what the block's columns add to the base, shape (n, rank)."""
    own = np.asfortranarray(block.columns)  # column by column, as it is gone through
    columns = np.asfortranarray(base.beyond(own))
    before, after = (np.sqrt(np.einsum("nk,nk->k", one, one)) for one in (own, columns))
    return orthonormal(columns[:, after > 1e-3 * np.where(before > 0, before, np.inf)])


def _likelihood(base: Base, share: FloatArray, inflation: float) -> float:
    """Gain of 2 ln L from explaining `share` (rank,) of the residual, per independent row."""
    power = float(base.residual @ base.residual)
    explained = min(float(share @ share) / power, 1.0 - 1e-12) if power > 0.0 else 0.0
    return float(-len(base.residual) * np.log1p(-explained) / inflation)


def _robust_p(by_stretch: FloatArray, signs: FloatArray) -> FloatArray:
    """P-value of the score for each row of signs, its covariance taken from the stretches themselves."""
    covariance = by_stretch.T @ by_stretch
    sums = signs @ by_stretch
    statistic = np.einsum("fi,fi->f", sums, np.linalg.lstsq(covariance, sums.T, rcond=1e-10)[0].T)
    return chance_beyond(statistic, by_stretch.shape[1])


def chance_beyond(statistic: FloatArray, degrees: int) -> FloatArray:
    """The chance of more than each statistic (n,) where chi-squared of so many degrees of freedom is expected."""
    if degrees == 1:  # as the incomplete gamma function has it, which takes fifty times as long
        tail: FloatArray = erfc(np.sqrt(0.5 * np.maximum(statistic, 0.0)))
        return tail
    return np.asarray(chdtrc(degrees, np.maximum(statistic, 0.0)))


def inflation_of(residual: FloatArray) -> float:
    """Rows per independent row, from the residual's lag-one correlation (AR(1): (1 + r) / (1 - r))."""
    power = float(residual @ residual)
    if power == 0.0:
        return 1.0
    lag_one = min(max(float(residual[:-1] @ residual[1:]) / power, 0.0), 0.95)
    return (1.0 + lag_one) / (1.0 - lag_one)


def _flipped(stretch: IntArray, seed: int) -> tuple[IntArray, FloatArray]:
    """Stretches (n,) counted from 0, and signs of each: as measured, then flipped, (1 + SIGN_FLIPS, stretches)."""
    _, labels = np.unique(stretch, return_inverse=True)
    count = int(labels.max()) + 1
    flips = np.random.default_rng(seed).choice(np.array([-1.0, 1.0]), size=(SIGN_FLIPS, count))
    return labels, np.vstack([np.ones(count), flips])
