"""Evidence for each candidate effect, from one fit of the base model.

Three numbers per candidate, never mixed up: a likelihood score for naming, a p-value that stays honest under
autocorrelation for detection, and (elsewhere) the held-out gain. See docs/explanation/diagnosis.md.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.special import chdtrc, erfc, fdtrc, fdtri

from compensator.lab.chance import LEAST_STATED, SIGN_FLIPS, SIGNIFICANT
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.base import Base, Block

SCREENINGS = 5  # of one diagnosis: steady effects, free curves, effects with memory, breakaway, the measuring chain
DRAWS = 9999
VERY_STRONG = 10.0  # of a score, twice a log Bayes factor (Kass, Raftery 1995)


class Sources(Protocol):
    """Noise of several sources, as `Noise` is."""

    @property
    def freedoms(self) -> FloatArray:
        """How well each is known, as a variance from so many squares, shape (s,)."""

    def shares(self, directions: FloatArray) -> FloatArray:
        """Of the variance in each direction (n, k) of whitened rows, of unit norm, what each has, shape (s, k)."""


@dataclass(frozen=True)
class Evidence:
    """What the rows say for one block.

    Attributes:
        block: the candidate.
        score: log-likelihood gain in units of 2 ln L, less the price of its parameters and shapes; > 0 speaks for it.
        noncentrality: the gain itself.
        p_value: of this block alone; of one at starts from rest, of as good a score in any block screened.
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
        chance: the same of any p-value (Westfall, Young 1993); those of starts from rest are that already.
    """

    evidence: list[Evidence]
    p_value: float
    chance: Callable[[float], float] = float


def screen(bases: Sequence[Base], blocks: Sequence[Block], noise: Sources) -> Screening:
    """Judge every block on whitened rows, against noise that is known.

    Where a few stretches hold all of an effect, as those at the highest speed do of drag, their flips can never say
    how sure it is; the noise of all rows can. The null is Gaussian. A variance that is made of several, each known from
    a few squares, is known from fewer than their sum where one of the few has most (Satterthwaite 1946).

    Args:
        bases: what blocks are judged on top of, whitened.
        blocks: candidates, whitened.
        noise: that whitened them.
    """
    found = [(block, bases[block.base], new_directions(bases[block.base], block)) for block in blocks]
    found = [(block, base, directions) for block, base, directions in found if directions.shape[1]]
    if not found:
        return Screening([], 1.0)
    together = np.concatenate([directions for _, _, directions in found], axis=1)
    starts = np.cumsum([0, *(directions.shape[1] for _, _, directions in found)])
    ranks = np.diff(starts)
    shares = np.add.reduceat(noise.shares(together), starts[:-1], axis=1) / ranks
    known_from = 1.0 / (shares.T**2 @ (1.0 / noise.freedoms))
    evidence = []
    for (block, base, directions), known in zip(found, known_from, strict=True):
        rows, rank = directions.shape
        share = directions.T @ base.residual
        gain = _likelihood(base, share, rows)
        p_value = float(fdtrc(rank, known, float(share @ share) / rank))
        evidence.append(
            Evidence(block, gain - _price(block, rank, rows), gain, p_value, _contribution(base, directions))
        )
    chance = _joint_chances(together, starts, shares, noise.freedoms, known_from)
    least = min(item.p_value for item in evidence)
    return Screening(sorted(evidence, key=lambda item: -item.score), chance(least), chance)


def _joint_chances(
    together: FloatArray, starts: IntArray, shares: FloatArray, freedoms: FloatArray, known_from: FloatArray
) -> Callable[[float], float]:
    """How likely white noise alone brings any of the blocks' own chances down to a given one.

    Args:
        together: directions of all blocks, orthonormal in each, shape (n, k).
        starts: where each block has its first, and k, shape (blocks + 1,).
        shares: of each source of noise in the variance of each block, shape (s, blocks).
        freedoms: how well each source is known, shape (s,).
        known_from: how well that of each block is, shape (blocks,).
    """
    powers, axes = np.linalg.eigh(together.T @ together)
    root = axes * np.sqrt(np.maximum(powers, 0.0))
    generator = np.random.default_rng(0)
    drawn = root @ generator.standard_normal((DRAWS, len(powers))).T
    known = (generator.chisquare(freedoms, (DRAWS, len(freedoms))) / freedoms) @ shares
    ranks = np.diff(starts)
    statistics = np.add.reduceat(drawn**2, starts[:-1], axis=0) / ranks[:, None] / known.T

    def chance(own: float) -> float:
        highest = fdtri(ranks, known_from, 1.0 - own) * (1.0 - 1e-9)
        return (1.0 + float(np.any(statistics >= highest[:, None], axis=0).sum())) / (1.0 + DRAWS)

    return chance


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
    independent = min(independent_rows(base.residual) for base in bases)
    for block in blocks:
        base = bases[block.base]
        directions = new_directions(base, block)
        rank = directions.shape[1]
        if rank == 0:
            continue
        if block.base == 0:
            shares = signs @ _sums(base, directions, labels)
            gains = np.array([_likelihood(base, share, independent) for share in shares])
        else:
            gains = independent * _gains_in_place(bases[model], base, directions, signs[:, labels])
        replaced = max(bases[model].basis.shape[1] - base.basis.shape[1], 0)
        scores = gains - _price(block, rank - replaced, independent)
        highest = np.maximum(highest, scores)
        gain = max(float(gains[0]), 0.0)
        evidence.append(Evidence(block, float(scores[0]), gain, 1.0, _contribution(base, directions)))
    ranked = sorted(evidence, key=lambda item: -item.score)
    ranked = [replace(item, p_value=_share_reaching(item.score, highest)) for item in ranked]
    return Screening(ranked, ranked[0].p_value if ranked else 1.0)


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
    gains: FloatArray = np.log(np.maximum(before, tiny) / np.maximum(after, tiny))
    return gains


def _share_reaching(score: float, highest: FloatArray) -> float:
    """The share of flips (f,), with what was measured among them, whose highest score reaches one."""
    return float(np.mean(highest >= score - 1e-9 * abs(score)))


def among_all(p_value: float) -> float:
    """The chance of so much evidence in any of a diagnosis's screenings (Bonferroni)."""
    return min(1.0, SCREENINGS * p_value)


def least_p_value(stretches: int) -> float:
    """The lowest p of a diagnosis on so many stretches: one flip of signs in 2^(stretches - 1) changes nothing."""
    return among_all(max(0.5 ** (stretches - 1), LEAST_STATED))


def too_few_stretches(stretches: int) -> bool:
    """Whether no evidence of a diagnosis on so many stretches could be more than chance."""
    return least_p_value(stretches) > SIGNIFICANT


def kept_evidence(bases: Sequence[Base], blocks: Sequence[Block]) -> dict[str, float]:
    """The greatest noncentrality of each name's blocks on top of the bases; 0 where nothing new is left."""
    kept: dict[str, float] = {}
    for block in blocks:
        base = bases[block.base]
        gain = _likelihood(base, new_directions(base, block).T @ base.residual, len(base.residual))
        kept[block.name] = max(kept.get(block.name, 0.0), gain)
    return kept


def most_likely(bases: Sequence[Base], blocks: Sequence[Block]) -> Block | None:
    """The block with the best score, of rows whose noise is not known yet; None where no score is above zero."""
    independent = min(independent_rows(base.residual) for base in bases)
    best, highest = None, 0.0
    for block in blocks:
        base = bases[block.base]
        directions = new_directions(base, block)
        gain = _likelihood(base, directions.T @ base.residual, independent)
        score = gain - _price(block, directions.shape[1], independent)
        best, highest = (block, score) if score > highest else (best, highest)
    return best


def _price(block: Block, rank: int, rows: float) -> float:
    return float(rank * np.log(rows) + 2.0 * np.log(block.scanned))


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


def _likelihood(base: Base, share: FloatArray, rows: float) -> float:
    """Gain of 2 ln L from explaining `share` (rank,) of the residual, of so many independent rows."""
    power = float(base.residual @ base.residual)
    explained = min(float(share @ share) / power, 1.0 - 1e-12) if power > 0.0 else 0.0
    return float(-rows * np.log1p(-explained))


def chance_beyond(statistic: FloatArray, degrees: int) -> FloatArray:
    """The chance of more than each statistic (n,) where chi-squared of so many degrees of freedom is expected."""
    if degrees == 1:  # as the incomplete gamma function has it, which takes fifty times as long
        tail: FloatArray = erfc(np.sqrt(0.5 * np.maximum(statistic, 0.0)))
        return tail
    return np.asarray(chdtrc(degrees, np.maximum(statistic, 0.0)))


def independent_rows(residual: FloatArray) -> float:
    """How many independent rows would tell as much, by the residual's lag-one correlation (AR(1))."""
    return len(residual) / inflation_of(residual)


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
