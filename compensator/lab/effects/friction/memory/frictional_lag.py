"""Frictional lag."""

import numpy as np
from numba import njit

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

LAGS_S = (0.01, 0.02, 0.04, 0.08, 0.16)  # of grease; of line contacts with oil 3 to 9 ms (Hess, Soom 1990)
LIKE_THE_CHAIN_S = 0.012  # a shorter one is what filters and delays of a drive make of a reversal


def shapes(motion: Motion) -> list[Shape]:
    """Speeds from the uncertain ones to half the fast ones, each with lags from a hundredth of a second on."""
    speeds = np.geomspace(2.0 * motion.slow, max(0.5 * motion.fast, 4.0 * motion.slow), 4)
    return [(float(speed), lag_s) for speed in speeds for lag_s in LAGS_S]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """How much more dry and viscous friction there is than at this speed for long, for shape (v_s, tau)."""
    speed, lag_s = shape
    fast = np.abs(motion.velocity)
    fade = np.exp(-motion.step_s / lag_s)
    return np.array([motion.direction * (_late(settled, fade) - settled) for settled in (np.exp(-fast / speed), fast)])


@njit(cache=True)
def _late(values: FloatArray, fade: float) -> FloatArray:
    """Values (n,) through a lag of first order that keeps such a share of itself from sample to sample."""
    late, state = np.empty(len(values)), values[0]
    for row in range(len(values)):
        state = (1.0 - fade) * values[row] + fade * state
        late[row] = state
    return late


def holds(shape: Shape, of_friction: float) -> bool:
    """Whether the lag is more than the measuring chain makes by itself.

    Rows tell how much friction lags times how long, where the lag is short: a short lag of more friction than there is
    is a longer one of all of it, or none at all.
    """
    return LIKE_THE_CHAIN_S < shape[1] * max(of_friction, 1.0) <= LAGS_S[-1]


EFFECT = Effect(
    name="frictional_lag",
    title="Frictional lag",
    physics=(
        "Friction follows a change of speed late, as the film between the surfaces thickens and thins: dry friction "
        "is larger while the speed rises than while it falls, and viscous friction smaller."
    ),
    equation=(
        r"(c\,(s - e^{-|\dot q|/v_s}) + b\,(u - |\dot q|))\,\mathrm{sgn}(\dot q),\quad "
        r"\tau\,\dot s = e^{-|\dot q|/v_s} - s,\ \tau\,\dot u = |\dot q| - u"
    ),
    columns=columns,
    parameters=(
        Parameter("dry friction that lags", "{effort}", 0.0),
        Parameter("viscous friction that lags", "{effort} s/{position}", 0.0),
    ),
    driver="acceleration",
    excited_by="slow motion whose speed rises and falls at several frequencies without reversing",
    source="Hess, Soom 1990; Armstrong, Dupont, Canudas de Wit 1994",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("speed over which friction falls", "lag"),
    shape_units=("{position}/s", "s"),
    confused_with=("inertia", "pre_sliding"),
    rows="moving",
    holds=holds,
    ends_within_scan=2,
)
