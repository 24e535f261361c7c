"""Coulomb friction."""

from compensator.lab.effects.effect import BreakawayShare, Effect, Motion, Onset, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """The direction of motion."""
    return motion.direction[None]


def at_breakaway(onset: Onset, _: Shape) -> FloatArray:
    """The same column; its coefficient is the static level, which holds the Stribeck excess too."""
    return onset.motion.direction[None]


BREAKAWAY = BreakawayShare(at_breakaway, (Parameter("static friction", "{effort}", 0.0),), "velocity")

EFFECT = Effect(
    name="coulomb",
    title="Coulomb friction",
    physics=("Friction of sliding contact: constant, against the motion."),
    equation=r"F_c\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(Parameter("Coulomb friction", "{effort}", 0.0),),
    driver="velocity",
    excited_by="motion in both directions at several speeds",
    source="Saini et al. 2013, eq. (2)",
    confused_with=("coulomb_asymmetry", "weight_friction"),
    breakaway=BREAKAWAY,
)
