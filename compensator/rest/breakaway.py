"""Load and friction of a joint at rest, from the two currents at which it breaks away (paper, eqs 9, 10)."""

from typing import NamedTuple

from compensator.errors import ModelParameterError


class BreakawayEstimate(NamedTuple):
    """What eqs (9) and (10) give.

    Attributes:
        load_current_a: I_load, the current of the load alone [A]; goes to the master.
        friction_current_a: F_load, the friction of the joint under this load [A]; selects the friction curve.
    """

    load_current_a: float
    friction_current_a: float


def estimate(min_current_a: float, max_current_a: float) -> BreakawayEstimate:
    """Eqs (9), (10). Assumes friction equal in both directions.

    Args:
        min_current_a: I_min, at which the joint just moves backwards [A].
        max_current_a: I_max, at which it just moves forwards [A].

    Raises:
        ModelParameterError: I_max is not above I_min, so no friction band lies between them.
    """
    if not max_current_a > min_current_a:
        raise ModelParameterError(
            f"I_max is {max_current_a:.4g} A and I_min {min_current_a:.4g} A; I_max must be above I_min (eqs 9, 10)"
        )
    load = (min_current_a + max_current_a) / 2
    friction = (abs(load - min_current_a) + abs(load - max_current_a)) / 2
    return BreakawayEstimate(load, friction)
