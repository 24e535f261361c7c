"""How what hangs beyond the gear moves, relative to the motor side that is measured.

Let d be how far the motor side is ahead. Were nothing between them, d would grow as the load needs to be driven:
d'' = (J a + gravity + springs) / J, the *parting*, all of it predicted. Free play holds d within a gap, an elastic
transmission pulls it back; either way the gear carries less than a rigid one by J d''.
"""

import numpy as np
from scipy.signal import lfilter

from compensator.lab.recordings.recording import FloatArray

# of the load that drawings and weights tell: far from 1, it is the shadow of something else
PLAUSIBLE_SHARE = (0.3, 3.0)
# of free play or compliance: up to so many times what the owner tells, teeth that bounce and data sheets explain it
TOLD = 2.0


def parting_in_free_play(parting: FloatArray, gap: float, step_s: float) -> FloatArray:
    """Acceleration d'' of a far side that is pushed by either flank of a gap and flies between them, shape (n,).

    Flanks do not bounce. Stoermer-Verlet, with the way held within the gap: a flank that is met takes the speed as the
    impulse that it is.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        gap: whole free play, in units of position.
        step_s: between samples.
    """
    high = 0.5 * gap
    low = -high
    way = before = high if len(parting) == 0 or parting[0] >= 0.0 else low
    ways = [before, way]
    for gain in (parting[:-1] * step_s**2).tolist():
        ahead = 2.0 * way - before + gain
        before, way = way, low if ahead < low else high if ahead > high else ahead
        ways.append(way)
    second: FloatArray = np.diff(np.array(ways), 2, append=ways[-1]) / step_s**2
    return second[: len(parting)]


def parting_on_a_spring(parting: FloatArray, resonance_rad_s: float, damping: float, step_s: float) -> FloatArray:
    """Acceleration d'' of a far side on a spring to the motor side, shape (n,): d'' + 2 D w d' + w^2 d = parting.

    Bilinear, the resonance where it belongs; at rest on its spring to begin with.

    Args:
        parting: acceleration of the way d, if nothing held it, shape (n,).
        resonance_rad_s: of the far side, the motor side held: the anti-resonance of the joint.
        damping: of that resonance, of critical.
        step_s: between samples.
    """
    warped = 2.0 / step_s * np.tan(0.5 * min(resonance_rad_s * step_s, 0.98 * np.pi))
    doubled = 2.0 / step_s
    square, lost = doubled**2, 2.0 * damping * warped * doubled
    numerator = np.array([square, -2.0 * square, square])
    denominator = np.array([square + lost + warped**2, 2.0 * (warped**2 - square), square - lost + warped**2])
    # at rest on its spring under the first parting: as if it had been so for ever
    found: FloatArray = lfilter(numerator, denominator, parting - parting[:1]) if len(parting) else parting
    return found
