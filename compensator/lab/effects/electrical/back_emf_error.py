"""A back-EMF constant that is not the motor's."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Velocity."""
    return motion.velocity[None]


EFFECT = Effect(
    name="back_emf_error",
    title="Back-EMF constant in error",
    physics=(
        "A voltage holds the back-EMF, and a current that is computed from duty and speed what its constant is off by: "
        "either sign, in proportion to speed, whatever brakes the joint."
    ),
    equation=r"\Delta k_e\,\dot q",
    columns=columns,
    parameters=(Parameter("error of the back-EMF constant, as effort", "{effort} s/{position}"),),
    driver="velocity",
    excited_by="a measured current, or a coast-down, in which the winding is open and friction brakes alone",
    source="Saini et al. 2013, eq. (3): i = (D U - k_e w) / R",
    confused_with=("viscous",),
    efforts=BY_VOLTAGE,
    hidden_by=("viscous",),
)
