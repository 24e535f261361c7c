"""Spring or cable torque whose stiffness changes along the way."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """The position's first three powers."""
    return motion.position ** [[1], [2], [3]]


PARAMETERS = (
    Parameter("stiffness at zero", "{effort}/{position}"),
    Parameter("stiffness gained per way, half of it", "{effort}/{position}2"),
    Parameter("cubic stiffness", "{effort}/{position}3"),
)

EFFECT = Effect(
    name="hardening_spring",
    title="Hardening spring or cable torque",
    physics=(
        "A cable or hose that gets stiffer the further it is bent, or a bumper: its torque grows faster than in "
        "proportion to the position. About any rest position that is the position's first three powers."
    ),
    equation=r"k_1 q + k_2 q^2 + k_3 q^3",
    columns=columns,
    parameters=PARAMETERS,
    driver="position",
    excited_by="slow motion over the whole range",
    source="Duffing 1918",
    confused_with=("spring", "gravity", "centre_of_mass_angle", "offset"),
    carried=True,
    by_position=True,
    breakaway=at_rest(columns, PARAMETERS, "position"),
)
