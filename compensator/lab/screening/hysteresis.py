"""A free hysteresis of position: what bends along with the joint, and slides when it is bent far enough.

A hose, a cable or a seal remembers where the joint has turned back. Whatever its law, as long as its loops close and
its speed does not matter, it is a sum of elastic sliders that give way at different distances (Prandtl 1928, Ishlinskii
1944; Krasnosel'skii, Pokrovskii 1989). A few of them are to such a law what the hats of a spline are to a curve: they
say that the position's past matters, and not why. Surfaces that give before they slide do so over less (`pre_sliding`).
"""

import numpy as np

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.reversals import slider
from compensator.lab.rows.dataset import Dataset

DRIVER = "since_reversal"
SHARES = (0.06, 0.2, 0.6)  # of the travel: from beyond what surfaces give to what hardly slides


def hysteresis_columns(dataset: Dataset) -> FloatArray:
    """Sliders of every distance over all rows, filtered like the effort, shape (N, len(SHARES))."""
    motions = [trial.motion for trial in dataset.trials]
    return dataset.stack(
        np.array([slider(motion.strokes, share * motion.position_span) for share in SHARES]) for motion in motions
    )
