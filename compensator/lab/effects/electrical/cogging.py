"""Cogging and gear-mesh ripple."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.effects.round_the_turn import orders, waves
from compensator.lab.recordings.recording import FloatArray

MOTOR_ORDERS = range(1, 37)  # poles, slots, commutator bars, and their common multiples


def shapes(motion: Motion) -> list[Shape]:
    """Orders of the joint and of the motor; the first and second of the joint are its weight's."""
    return orders(motion, MOTOR_ORDERS, lowest=3, fewest_cycles=2)


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of the k-th order of the joint, averaged over a sample."""
    return waves(motion, shape[0])


EFFECT = Effect(
    name="cogging",
    title="Cogging",
    physics=(
        "The magnets pull the rotor towards the slots of the iron, and wheels mesh unevenly: a torque that "
        "goes round with the shaft, whatever the direction of motion. Looked for: 3 to 30 waves per turn of the joint, "
        "as one and two are its weight's, up to 36 per turn of the motor where the gear ratio is told, and any number "
        "that comes back for sure, as of a wheel between them."
    ),
    equation=r"a \cos kq + b \sin kq",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{effort}"),
        Parameter("sine part", "{effort}"),
    ),
    driver="position",
    excited_by="slow motion over the whole range, in both directions",
    source="Jahns, Soong 1996",
    shapes=shapes,
    shape_names=("order",),
    goes_round="force",
    confused_with=("position_periodic_friction", "spring"),
)
