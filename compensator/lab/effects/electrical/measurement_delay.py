"""Measurement delay."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Rate of change of the predicted effort."""
    return motion.effort_rate[None]


EFFECT = Effect(
    name="measurement_delay",
    title="Measurement delay",
    physics=(
        "The position is older than the effort: the model then sees the motion late. To first order the error "
        "is the rate of change of the predicted effort times the delay."
    ),
    equation=r"\Delta t\,\dot{\hat\tau}",
    columns=columns,
    parameters=(Parameter("delay", "s", -0.1, 0.1),),
    driver="effort_rate",
    excited_by="fast reversals and frequencies above 3 Hz",
    source="first-order expansion in the delay",
    confused_with=("inertia",),
    builds_on="effort",
    pipeline=True,
    standing_in=frozenset({"jerk", "sign_rate"}),
)
