"""What chance of a false alarm each question about what a model leaves may spend: all of them, in one place.

A complete model is asked many things, and is falsely alarmed about where noise alone answers any of them: their
chances add up (Bonferroni). So each has its part of one percent, the larger the more a moderate cause needs it. A part
is smaller where the tails of a statistic are known less well than its middle, or where joints that lack nothing have a
little of what is asked for.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorBudget:
    """Chances in noise alone, each over all that its question tries.

    Attributes:
        wandering: dry friction, or a constant force, is another one for seconds; of each of both.
        swing: it swings at one frequency.
        ripple: it swings so with the voltage, as nothing in a joint that lacks nothing does.
        line: it comes back with the position.
        growing: it does so, and grows with the square of the speed, which nothing in a joint that lacks nothing does.
    """

    wandering: float
    swing: float
    ripple: float
    line: float
    growing: float


PLAIN = ErrorBudget(
    wandering=5e-4,
    swing=5e-5,
    ripple=5e-4,
    line=1e-6,
    growing=1e-4,
)
"""Of a model that is what every joint has."""

WANDERING_BESIDE_A_NAME = 1e-4
"""A further formula, though nearly right, leaves some of friction."""
