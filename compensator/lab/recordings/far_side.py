"""How what hangs beyond the gear moves, relative to the motor side that is measured.

Let d be how far the motor side is ahead. Were nothing between them, d would grow as the load needs to be driven:
d'' = (J a + gravity + springs) / J, the *parting*, all of it predicted. Free play holds d within a gap, an elastic
transmission pulls it back; either way the gear carries less than a rigid one by J d''.
"""

import numpy as np
from numba import njit

from compensator.lab.recordings.recording import FloatArray

# of the load that drawings and weights tell: far from 1, it is the shadow of something else
PLAUSIBLE_SHARE = (0.3, 3.0)
# of free play or compliance: up to so many times what the owner tells, teeth that bounce and data sheets explain it
TOLD = 2.0
STIFFEST = 1.5  # resonance times time step, up to which samples can show a swing
ABOUT_KNOWN = (0.6, 1.0, 1.6)  # shares of the free play that is told: so little is it known


def parting_in_free_play(parting: FloatArray, gap: float, step_s: float) -> FloatArray:
    """Acceleration d'' of a far side that is pushed by either flank of a gap and flies between them, shape (n,).

    Flanks do not bounce. Stoermer-Verlet, with the way held within the gap: a flank that is met takes the speed as the
    impulse that it is.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        gap: whole free play, in units of position.
        step_s: between samples.
    """
    if len(parting) == 0:
        return parting
    second: FloatArray = np.diff(_ways_in_free_play(parting, 0.5 * gap, step_s), 2) / step_s**2
    return second


def flights(parting: FloatArray, gap: float, step_s: float) -> list[FloatArray]:
    """`parting_in_free_play` for free play as little known as a data sheet tells it. Arguments as there."""
    return [parting_in_free_play(parting, share * gap, step_s) for share in ABOUT_KNOWN]


@njit(cache=True)
def _ways_in_free_play(parting: FloatArray, high: float, step_s: float) -> FloatArray:
    """How far the motor side is ahead: on a flank before the first sample, and resting after the last; (n + 2,)."""
    ways = np.empty(len(parting) + 2)
    way = before = high if parting[0] >= 0.0 else -high
    ways[0] = ways[1] = way
    for step in range(len(parting) - 1):
        ahead = 2.0 * way - before + parting[step] * step_s**2
        before, way = way, min(max(ahead, -high), high)
        ways[step + 2] = way
    ways[-1] = way
    return ways


def parting_on_a_spring(parting: FloatArray, resonance_rad_s: float, damping: float, step_s: float) -> FloatArray:
    """Acceleration d'' of a far side on a spring to the motor side, shape (n,): d'' + 2 D w d' + w^2 d = parting.

    Bilinear, the resonance where it belongs; at rest on its spring to begin with.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        resonance_rad_s: of the far side, the motor side held: the anti-resonance of the joint.
        damping: of that resonance, of critical.
        step_s: between samples.
    """
    stiffest = STIFFEST / step_s
    if resonance_rad_s > stiffest:  # far below resonance only the compliance counts, which goes by its square
        return (stiffest / resonance_rad_s) ** 2 * parting_on_a_spring(parting, stiffest, damping, step_s)
    warped = 2.0 / step_s * np.tan(0.5 * resonance_rad_s * step_s)
    doubled = 2.0 / step_s
    square, lost = doubled**2, 2.0 * damping * warped * doubled
    first = square + lost + warped**2
    ahead, twice, once = square / first, 2.0 * (warped**2 - square) / first, (square - lost + warped**2) / first
    # at rest on its spring under the first parting: as if it had been so for ever
    return _swung(parting - parting[:1], ahead, twice, once) if len(parting) else parting


@njit(cache=True)
def _swung(driven: FloatArray, ahead: float, twice: float, once: float) -> FloatArray:
    """y[i] = ahead (x[i] - 2 x[i-1] + x[i-2]) - twice y[i-1] - once y[i-2] of x (n,), from rest."""
    found, before, earlier = np.empty(len(driven)), 0.0, 0.0
    for step in range(len(driven)):
        found[step] = before + ahead * driven[step]
        before = earlier - 2.0 * ahead * driven[step] - twice * found[step]
        earlier = ahead * driven[step] - once * found[step]
    return found
