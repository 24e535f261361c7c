"""Backlash."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.effects.mechanics.beyond_teeth import arm_shares, beyond_teeth
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.far_side import PLAUSIBLE_SHARE, TOLD, in_free_play
from compensator.lab.recordings.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Gaps from a two-thousandth to a fifth of the travel, and shares of the arm in the inertia without load."""
    gaps = motion.position_span * np.geomspace(5e-4, 0.2, 19)
    return [(float(gap), share) for gap in gaps for share in arm_shares(motion.facts)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What the gear carries less while the far side flies through the gap, the blow that ends it, and the load's place.

    On either flank the load hangs half a gap from where a rigid gear would have it.

    Args:
        motion: of the motor side.
        shape: gap, and share of the arm in the inertia without load.
    """
    inertia, parting = beyond_teeth(motion, shape[1])
    if inertia <= 0.0:
        return np.zeros((1, len(parting)))
    second, ways = in_free_play(parting, shape[0], motion.step_s, motion.carried_slope / inertia)
    return -(inertia * second + motion.carried_slope * ways)[None]


def told(facts: Facts, shape: Shape) -> bool:
    """Whether the gap is hardly more than the free play that is known."""
    return shape[0] <= TOLD * (facts.backlash_rad or 0.0)


EFFECT = Effect(
    name="backlash",
    title="Backlash",
    physics=(
        "Where the load would run ahead of the motor, the teeth let go of it: it flies through the free play, and the "
        "motor carries nothing of it until the other flank catches it with a blow. How the far side flies follows from "
        "the motion of the motor and from the load that the model predicts. On a flank the load hangs half a gap from "
        "where the motor is, and weighs accordingly."
    ),
    equation=(
        r"-s\,(\hat J_a\,\ddot d + \hat\tau_{load}'(q)\, d),\quad \hat J_a\,\ddot d = \hat\tau_{load} - "
        r"\hat\tau_{load}'(q)\, d \text{ between the flanks, } |d| \le b/2"
    ),
    columns=columns,
    parameters=(Parameter("load beyond the gap over the load that is known", "1", *PLAUSIBLE_SHARE),),
    driver="since_reversal",
    excited_by="many changes of sign of the torque that the gear carries: fast reversals, sweeps about the bottom",
    source="Nordin, Gutman 2002",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("free play", "share of the arm in the inertia without load"),
    shape_units=("{position}", "1"),
    confused_with=("pre_sliding", "elasticity"),
    builds_on="load",
    rows="moving",
    told=told,
)
