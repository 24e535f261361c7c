"""Columns that the measuring pipeline itself can produce, so that none of them is mistaken for physics.

They stand in every diagnosis. A small delay looks like jerk; a sign smoothed by filtering or backlash looks like a
difference of steep sigmoids. An effect that means one of these (see `Effect.standing_in`) is judged without it.
"""

import numpy as np

from compensator.lab.effects import backlash, measurement_delay
from compensator.lab.effects.effect import Motion, MotionRows
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset

NAMES = ("jerk", "slow_sign", "fast_sign", "sign_rate")
KNOWN_PLAY = {"known_play_less": 0.6, "known_play": 1.0, "known_play_more": 1.6}  # of what the owner knows: not missing


def nuisance_columns(dataset: Dataset, show_in: MotionRows = "sliding") -> dict[str, FloatArray]:
    """Each nuisance column by name, shape (N,).

    Near reversals a delay looks like memory: there its own column stands too, and that of the free play that is known.
    """
    stack = dataset.stack([_columns(trial.motion, trial.signals.rate_hz) for trial in dataset.trials])
    named = dict(zip(NAMES, stack.T, strict=True))
    if show_in == "sliding":
        return named
    named["delay"] = dataset.columns(measurement_delay.EFFECT, ())[:, 0]
    if dataset.facts.backlash_rad:
        gaps = [(share * dataset.facts.backlash_rad,) for share in KNOWN_PLAY.values()]
        found = dataset.unchecked_columns(backlash.EFFECT, gaps)
        named |= {name: columns[:, 0] for name, columns in zip(KNOWN_PLAY, found, strict=True)}
    return named


def _columns(motion: Motion, rate_hz: float) -> FloatArray:
    slow = motion.velocity / motion.slow
    sigmoids = [np.tanh(slow / width) for width in (1.0, 3.0, 10.0)]
    return np.array(
        [
            motion.jerk,
            sigmoids[0] - sigmoids[1],
            sigmoids[1] - sigmoids[2],
            rate_of_change(sigmoids[1], rate_hz),
        ]
    )
