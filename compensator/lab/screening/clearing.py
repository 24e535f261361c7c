"""The noise that a complete model would leave, learnt before anybody knows what is missing."""

from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import most_likely
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.stops import StopToStop

CLEARED = 2  # blocks, or free curves, that are taken off at most: what is missing must not count as noise


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, evened by the noise of what is left once the likeliest blocks are in the model."""
    left = gathered
    for _ in range(CLEARED):
        block = most_likely(left.bases, [*left.named, *left.curves.blocks])
        if block is None:
            break
        left = left.with_block(block)
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    strokes = StopToStop.of(gathered.fit, gathered.rows, gathered.weights)
    base = left.bases[0]
    noise = Noise.learnt(gathered.fit.dataset, gathered.rows, (base.basis, base.residual), before, strokes)
    return gathered.evened(noise)
