"""The noise that a complete model would leave, learnt before anybody knows what is missing."""

from dataclasses import replace

from scipy.stats import f as fisher

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import Block, among_all, most_likely, new_directions, score_of
from compensator.lab.screening.noise import Noise, strength
from compensator.lab.screening.stops import StopToStop

CLEARED = 2  # blocks, or free curves, that are taken off at most: what is missing must not count as noise
SURE = 0.01


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, evened by the noise of what is left once the likeliest blocks are in the model.

    A block is taken off only where it pays against the noise as it is known so far, with its colour, or is no chance
    beside the noise that is left without it. Held against white noise, slow blocks seem to pay wherever noise is slow;
    without its slow part, all slow blocks would be sure.
    """
    left, noise = gathered, _learnt(gathered, gathered)
    for _ in range(CLEARED):
        blocks = [*left.named, *left.curves.blocks]
        block = most_likely(left.bases, blocks)
        if block is None:
            break
        cleared = left.with_block(block)
        without = _learnt(gathered, cleared)
        if score_of(left.bases, block, noise) <= 0.0 and not _stands_out(left, block, (noise, without), len(blocks)):
            break
        left, noise = cleared, without
    return gathered.evened(noise)


def noise_without(gathered: Candidates, columns: FloatArray) -> Noise:
    """Of the same rows, where something else may be missing, too: columns (n, k), weighted, as they were measured."""
    plain = replace(gathered, bases=[gathered.as_measured(WITH_CHAIN)])
    return _learnt(plain, replace(plain, bases=[plain.bases[0].extended(columns)]))


def _stands_out(left: Candidates, block: Block, noises: tuple[Noise, Noise], tried: int) -> bool:
    """Whether a block is no chance, though the noise that is learnt with it in it is about as large as it is.

    What comes back at one order of the angle, in all trials, is most of what there is of its colour: held against a
    noise that has it, it is hidden by itself. With k columns, and noise of that colour known from m others alike, the
    strengths against noise with and without it are s_0 = s_1 (m + k) / (s_1 + m): that tells m, and Snedecor's F of k
    and m how sure it is, times all blocks that might have been the likeliest (Bonferroni).

    Args:
        left: what was taken off before.
        block: the likeliest one.
        noises: with it, and without it.
        tried: how many blocks there are.
    """
    base = left.bases[block.base]
    directions = new_directions(base, block)
    share, rank = directions.T @ base.residual, directions.shape[1]
    with_it, without_it = (strength(share, replace(one, evening=None).covariance(directions)) for one in noises)
    if not rank < with_it < without_it:
        return False
    known_from = without_it * (with_it - rank) / (without_it - with_it)
    return among_all(tried * float(fisher.sf(without_it / rank, rank, known_from))) <= SURE


def _learnt(gathered: Candidates, left: Candidates) -> Noise:
    """From what is left of the candidates' rows."""
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    strokes = StopToStop.of(gathered.fit, gathered.rows, gathered.weights)
    base = left.bases[0]
    return Noise.learnt(gathered.fit.dataset, gathered.rows, (base.basis, base.residual), before, strokes)
