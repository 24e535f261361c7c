"""How what hangs beyond the gear moves, relative to the motor side that is measured.

Let d be how far the motor side is ahead. Were nothing between them, d would grow as the load needs to be driven:
d'' = (J a + gravity + springs) / J, the *parting*, all of it predicted. Free play holds d within a gap, an elastic
transmission pulls it back; either way the gear carries less than a rigid one by J d''. And the load hangs where the far
side is: d behind, where gravity and springs are less by d times their slope over the position.
"""

import numpy as np
from numba import njit
from scipy.fft import irfft, next_fast_len, rfft

from compensator.lab.recordings.recording import FloatArray

# of the load that drawings and weights tell: far from 1, it is the shadow of something else
PLAUSIBLE_SHARE = (0.3, 3.0)
# of free play or compliance: up to so many times what the owner tells, teeth that bounce and data sheets explain it
TOLD = 2.0
SWUNG_OUT = 4.6  # time constants of a swing's decay, after which a hundredth of it goes on at the beginning
LONGEST_S = 60.0  # that is waited for: what swings on for longer hardly hangs on its spring
FADES_S = 0.5  # what drives it, after the last sample
ABOUT_KNOWN = (0.6, 1.0, 1.6)  # shares of the free play that is told: so little is it known


def in_free_play(
    parting: FloatArray, gap: float, step_s: float, slope: FloatArray | float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """How a far side moves that is pushed by either flank of a gap and flies between them: d'' and d, shape (n,) each.

    Flanks do not bounce. Stoermer-Verlet, with the way held within the gap: a flank that is met takes the speed as the
    impulse that it is.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        gap: whole free play, in units of position.
        step_s: between samples.
        slope: of the parting over the position [1/s^2], shape (n,).
    """
    if len(parting) == 0:
        return parting, parting
    ways = _ways_in_free_play(parting, np.full(len(parting), slope), 0.5 * gap, step_s)
    return np.diff(ways, 2) / step_s**2, ways[1:-1]


def flights(parting: FloatArray, gap: float, step_s: float) -> list[FloatArray]:
    """Accelerations d'' as `in_free_play` has them, for free play as little known as a data sheet tells it."""
    return [in_free_play(parting, share * gap, step_s)[0] for share in ABOUT_KNOWN]


@njit(cache=True)
def _ways_in_free_play(parting: FloatArray, slope: FloatArray, high: float, step_s: float) -> FloatArray:
    """How far the motor side is ahead: on a flank before the first sample, and resting after the last; (n + 2,)."""
    ways = np.empty(len(parting) + 2)
    way = before = high if parting[0] >= 0.0 else -high
    ways[0] = ways[1] = way
    for step in range(len(parting) - 1):
        ahead = 2.0 * way - before + (parting[step] - slope[step] * way) * step_s**2
        before, way = way, min(max(ahead, -high), high)
        ways[step + 2] = way
    ways[-1] = way
    return ways


def parting_on_a_spring(parting: FloatArray, resonance_rad_s: float, damping: float, step_s: float) -> FloatArray:
    """Acceleration d'' of a far side on a spring to the motor side, shape (n,): d'' + 2 D w d' + w^2 d = parting.

    By the transfer function s^2 / (s^2 + 2 D w s + w^2) over the frequencies that samples can hold, so that a spring
    whose resonance lies beyond them gives as much as it does; at rest on its spring to begin with.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        resonance_rad_s: of the far side, the motor side held: the anti-resonance of the joint.
        damping: of that resonance, of critical.
        step_s: between samples.
    """
    count = len(parting)
    if count < 2:
        return np.zeros(count)
    begun = parting - parting[0]  # at rest on its spring under the first parting: as if it had been so for ever
    later = np.arange(1, int(FADES_S / step_s) + 2)  # a jump back to that would ring all along
    fading = (begun[-1] + later * (begun[-1] - begun[-2])) * np.cos(0.5 * np.pi * later / later[-1]) ** 2
    driven = np.concatenate([begun, fading])
    swung_out_s = min(SWUNG_OUT / (damping * resonance_rad_s), LONGEST_S)
    whole = next_fast_len(len(driven) + int(swung_out_s / step_s), real=True)
    s = 2j * np.pi * np.fft.rfftfreq(whole, step_s)
    passed = s**2 / (s**2 + 2.0 * damping * resonance_rad_s * s + resonance_rad_s**2)
    found: FloatArray = irfft(passed * rfft(driven, whole), whole)[:count]
    return found
