"""The noise that a complete model would leave, learnt before anybody knows what is missing."""

from dataclasses import replace

from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import most_likely
from compensator.lab.screening.noise import Noise

CLEARED = 2  # blocks that are taken off at most: what is missing must not count as noise


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, and the noise of their rows: what is left once the likeliest blocks are in the model."""
    left, taken = gathered, gathered.bases[0].basis.shape[1]
    for _ in range(CLEARED):
        block = most_likely(left.bases, left.named)
        if block is None:
            break
        left = left.with_block(block)
        taken = left.bases[0].basis.shape[1]
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    noise = Noise.learnt(gathered.fit.dataset, gathered.rows, left.bases[0].residual, taken, before)
    return replace(gathered, noise=noise)
