"""What goes round with the shaft: its orders, and their waves."""

from collections.abc import Sequence

import numpy as np

from compensator.lab.effects.effect import Motion, Shape
from compensator.lab.recordings.recording import FloatArray

SHORT = 3  # an order per turn of which most travels hold half a wave
MOST = 30  # per turn of the joint, or cycles over a linear joint's travel


def orders(motion: Motion, of_motor: Sequence[int], lowest: int, fewest_cycles: int) -> list[Shape]:
    """Orders per joint turn, and per motor turn where the gear ratio is known; cycles over a linear joint's travel.

    Args:
        motion: of any trial.
        of_motor: orders per motor turn; those that are among the joint's are left out.
        lowest: order per joint turn. One below 3 is of use only where the travel holds half a wave of it.
        fewest_cycles: over the travel of a linear joint.
    """
    if motion.facts.joint != "rotary":
        return [(2.0 * np.pi * cycles / motion.position_span,) for cycles in range(fewest_cycles, MOST + 1)]
    held = [order for order in range(lowest, SHORT) if order * motion.position_span >= np.pi]
    joint: list[Shape] = [(float(order),) for order in (*held, *range(SHORT, MOST + 1))]
    ratio = motion.facts.gear_ratio
    return joint if ratio is None else joint + [(order * ratio,) for order in of_motor if order * ratio > MOST]


def waves(motion: Motion, order: float) -> FloatArray:
    """Cosine and sine of an order, averaged over a sample; shape (2, n)."""
    phase = order * motion.position
    return np.array([np.cos(phase), np.sin(phase)]) * motion.averaged(order)
