"""What hangs beyond the teeth, where the owner does not tell how much of the inertia is the arm's."""

from compensator.lab.effects.effect import Motion
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import FloatArray

TOLD_ARM = 1.0  # all of the inertia that is known lies beyond
SHARES = (0.15, 0.4, TOLD_ARM)  # of the arm in the inertia without load; the rest is the motor's


def arm_shares(facts: Facts) -> tuple[float, ...]:
    """Shares of the arm in the inertia without load that are to be tried; all of it where the arm's is told."""
    return (TOLD_ARM,) if facts.arm_inertia_kg_m2 or facts.joint == "linear" else SHARES


def beyond_teeth(motion: Motion, share: float) -> tuple[float, FloatArray]:
    """Effort per acceleration of what hangs beyond the teeth, and its `parting` (n,), for a share of the arm."""
    inertia = motion.load_inertia + share * (motion.inertia_beyond - motion.load_inertia)
    if inertia <= 0.0:
        return 0.0, motion.parting
    weight = motion.inertia_beyond * (motion.parting - motion.acceleration)
    return inertia, weight / inertia + motion.acceleration
