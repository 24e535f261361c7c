"""The noise that a complete model would leave, learnt before anybody knows what is missing."""

from dataclasses import replace

from compensator.lab.effects.catalogue import chain_effects
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import most_likely, score_of
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.stops import StopToStop

CLEARED = 2  # blocks, or free curves, that are taken off at most: what is missing must not count as noise


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, evened by the noise of what is left once the likeliest blocks are in the model.

    Of the joint's blocks alone: what the measuring chain does badly is noise to whoever asks what the joint lacks.
    A block is taken off only where it pays against the noise as it is known so far, with its colour: held against white
    noise, slow blocks seem to pay wherever noise is slow.
    """
    left, noise = gathered, _learnt(gathered, gathered)
    joint = [block for block in gathered.named if block.name not in chain_effects()]
    for _ in range(CLEARED):
        block = most_likely(left.bases, [*joint, *left.curves.blocks])
        if block is None:
            break
        if score_of(left.bases, block, noise) <= 0.0:
            break
        left = left.with_block(block)
        noise = _learnt(gathered, left)
    return gathered.evened(noise)


def noise_without(gathered: Candidates, columns: FloatArray) -> Noise:
    """Of the same rows, where something else may be missing, too: columns (n, k), weighted, as they were measured."""
    plain = replace(gathered, bases=[gathered.as_measured(WITH_CHAIN)])
    return _learnt(plain, replace(plain, bases=[plain.bases[0].extended(columns)]))


def _learnt(gathered: Candidates, left: Candidates) -> Noise:
    """From what is left of the candidates' rows."""
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    strokes = StopToStop.of(gathered.fit, gathered.rows, gathered.weights)
    base = left.bases[0]
    return Noise.learnt(gathered.fit.dataset, gathered.rows, (base.basis, base.residual), before, strokes)
