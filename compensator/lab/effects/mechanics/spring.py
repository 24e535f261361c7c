"""Spring or cable torque."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Position."""
    return motion.position[None]


PARAMETERS = (Parameter("stiffness", "{effort}/{position}"),)

EFFECT = Effect(
    name="spring",
    title="Spring or cable torque",
    physics=("A cable, hose or balancing spring that pulls towards a rest position; its constant part is the offset."),
    equation=r"k\,q",
    columns=columns,
    parameters=PARAMETERS,
    driver="position",
    excited_by="slow motion over the whole range",
    source="Hooke",
    confused_with=("gravity", "offset"),
    carried=True,
    by_position=True,
    breakaway=at_rest(columns, PARAMETERS, "position"),
)
