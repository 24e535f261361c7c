"""Viscous friction."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Velocity."""
    return motion.velocity[None]


EFFECT = Effect(
    name="viscous",
    title="Viscous friction",
    physics=(
        "Friction of lubricant shear, proportional to speed. Where the effort is a voltage, back-EMF has the "
        "same form and is part of it; where it is a current estimated from duty and speed, what the data sheet's "
        "back-EMF constant is off by, which may be more than the friction."
    ),
    equation=r"F_v\,\dot q",
    columns=columns,
    parameters=(Parameter("viscous friction", "{effort} s/{position}", 0.0),),
    driver="velocity",
    excited_by="speeds spread over at least a factor of ten",
    source="Saini et al. 2013, section 2.1",
    confused_with=("viscous_quadratic", "stribeck"),
    unbounded_in=("current_estimate",),
)
