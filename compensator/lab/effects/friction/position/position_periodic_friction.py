"""Position-periodic friction."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.effects.round_the_turn import orders, waves
from compensator.lab.recordings.recording import FloatArray

MOTOR_ORDERS = (1, 2)  # an eccentric pinion; the wave generator of a harmonic drive


def shapes(motion: Motion) -> list[Shape]:
    """Orders of the joint and of the motor."""
    return orders(motion, MOTOR_ORDERS, lowest=1, fewest_cycles=1)


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of the k-th order against the motion, averaged over a sample."""
    return waves(motion, shape[0]) * motion.direction


EFFECT = Effect(
    name="position_periodic_friction",
    title="Position-periodic friction",
    physics=(
        "Friction that rises and falls round the turn: a bent shaft, an eccentric gear, a damaged tooth. Looked for: 1 "
        "to 30 waves per turn of the joint, as far as the travel holds half of one, 1 and 2 per turn of the motor, "
        "and any number that comes back for sure, as of a wheel between them."
    ),
    equation=r"(a \cos kq + b \sin kq)\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{effort}"),
        Parameter("sine part", "{effort}"),
    ),
    driver="position",
    excited_by="slow motion over the whole range, in both directions",
    source="Garcia et al. 2002; common in harmonic drives",
    shapes=shapes,
    shape_names=("order",),
    goes_round="against the motion",
    confused_with=("load_friction",),
    dry_friction=True,
)
