"""The typical step between the samples of a recording, and where one is so long that it is a gap."""

import numpy as np
from numpy.typing import NDArray

from compensator.lab.recordings.recording import FloatArray

LONGEST_GAP_PERIODS = 5.0


def typical_step_s(time_s: FloatArray) -> float:
    """The step between samples that half of the recorded time is not longer than.

    A drive that is polled may answer twice at once and then not for a while, so that steps of 1 and 14 ms alternate:
    their median is the one or the other by a hair, and every step of 14 ms would be a gap. Most of the time passes in
    the long ones.

    Args:
        time_s: rising, at least two samples.
    """
    steps = np.sort(np.diff(time_s))
    passed = np.cumsum(steps)
    return float(steps[np.searchsorted(passed, 0.5 * passed[-1])])


def is_before_gap(time_s: FloatArray) -> NDArray[np.bool_]:
    """Whether the next sample comes so late that nothing can be said of the time between, shape (n,).

    Args:
        time_s: rising, at least two samples.
    """
    late: NDArray[np.bool_] = np.append(np.diff(time_s) > LONGEST_GAP_PERIODS * typical_step_s(time_s), False)
    return late
