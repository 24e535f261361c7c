"""Load-dependent friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray

UNCERTAIN_SHARE = 0.05  # of the largest effort: the sign of a smaller load is uncertain
BEYOND_SHARE = 0.02  # of it: what bearings beyond the teeth may take


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Transmitted load against the motion."""
    return (np.abs(motion.load_effort) * motion.direction)[None]


def discrepancy(motion: Motion, _: Shape) -> FloatArray:
    """What else the teeth transmit, friction and inertia beyond them: derivatives of |load + F sgn v + D v + J a|.

    Near a load of none there are no such derivatives: there teeth transmit F itself, and not next to nothing.
    """
    side = np.tanh(motion.load_effort / (UNCERTAIN_SHARE * (motion.largest_effort or 1.0)))
    beyond = _beyond(motion, BEYOND_SHARE * motion.largest_effort)
    return np.array([side, side * np.abs(motion.velocity), side * motion.acceleration * motion.direction, beyond])


def _beyond(motion: Motion, friction: float) -> FloatArray:
    """What friction beyond the teeth adds to what they transmit, and so to what is lost in them, shape (n,)."""
    against = motion.direction * friction
    added: FloatArray = (np.abs(motion.load_effort + against) - np.abs(motion.load_effort)) * motion.direction
    return added


PARAMETERS = (Parameter("share of the load lost", "1", 0.0, 1.0),)

EFFECT = Effect(
    name="load_friction",
    title="Load-dependent friction",
    physics=(
        "Gear friction in proportion to the torque that the teeth transmit. The load is predicted by the "
        "model, never taken from the measured effort."
    ),
    equation=r"\mu\,|\hat\tau_{load}|\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=PARAMETERS,
    driver="load",
    excited_by="several loads, moved slowly up and down",
    source="Rhoban/bam, model M3; Saini et al. 2013, section 3.2.2",
    confused_with=("load_friction_quadratic", "position_periodic_friction", "weight_friction"),
    builds_on="load",
    breakaway=at_rest(columns, PARAMETERS, "load"),
    dry_friction=True,
    discrepancy=discrepancy,
)
