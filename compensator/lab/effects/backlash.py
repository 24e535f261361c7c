"""Backlash."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recording import FloatArray
from compensator.lab.reversals import in_free_play


def shapes(motion: Motion) -> list[Shape]:
    """Gaps from a five-hundredth to a fifth of the travel."""
    return [(float(share * motion.position_span),) for share in np.geomspace(2e-3, 0.2, 19)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Friction and inertia that the motor does not feel in the gap, for shape (gap,)."""
    strokes = motion.strokes
    free = in_free_play(strokes, shape[0])
    return np.array([-strokes.sign[strokes.index] * free, -motion.acceleration * free])


EFFECT = Effect(
    name="backlash",
    title="Backlash",
    physics=(
        "After a reversal the motor crosses the free play of the gear alone: friction and inertia beyond the "
        "teeth are missing until the gap is closed."
    ),
    equation=r"-(F_a\,\mathrm{sgn}\,\dot q + J_a\,\ddot q)\;[\text{in the gap}]",
    columns=columns,
    parameters=(
        Parameter("friction beyond the gap", "{effort}", 0.0),
        Parameter("inertia beyond the gap", "{effort} s2/{position}", 0.0),
    ),
    driver="since_reversal",
    excited_by="many reversals without a load that holds the teeth to one flank",
    source="Nordin, Gutman 2002",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("free play",),
    confused_with=("pre_sliding", "elasticity"),
    standing_in=frozenset({"slow_sign", "fast_sign", "sign_rate"}),
    rows="moving",
)
