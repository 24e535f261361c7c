"""The noise that a complete model would leave, learnt before anybody knows what is missing."""

from compensator.lab.effects.catalogue import chain_effects
from compensator.lab.screening.candidates import Candidates, noise_of
from compensator.lab.screening.evidence import most_likely, score_of

CLEARED = 2  # blocks, or free curves, that are taken off at most: what is missing must not count as noise


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, evened by the noise of what is left once the likeliest blocks are in the model.

    Of the joint's blocks alone: what the measuring chain does badly is noise to whoever asks what the joint lacks.
    A block is taken off only where it pays against the noise as it is known so far, with its colour: held against white
    noise, slow blocks seem to pay wherever noise is slow.
    """
    left, noise = gathered, noise_of(gathered, gathered)
    joint = [block for block in gathered.named if block.name not in chain_effects()]
    for _ in range(CLEARED):
        block = most_likely(left.bases, [*joint, *left.curves.blocks])
        if block is None:
            break
        if score_of(left.bases, block, noise) <= 0.0:
            break
        left = left.with_block(block)
        noise = noise_of(gathered, left)
    return gathered.evened(noise)
