"""Coulomb friction that differs by quadrant."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

FLANK_SHARE = 0.01  # of the largest effort, over which flanks change: loads are known about so well


def columns(motion: Motion, _: Shape) -> FloatArray:
    """The flank that carries the load, while moving; and the same against the motion."""
    side = np.tanh(motion.load_effort / (FLANK_SHARE * (motion.largest_effort or 1.0)))
    return np.array([side * np.abs(motion.direction), side * motion.direction])


EFFECT = Effect(
    name="coulomb_quadrant",
    title="Coulomb friction by quadrant",
    physics=(
        "Teeth and worms rub differently where they drive and where they hold back, and on either flank: Coulomb "
        "friction has another value in each quadrant of speed and load."
    ),
    equation=r"(\Delta_1\,|\mathrm{sgn}\,\dot q| + \Delta_2\,\mathrm{sgn}\,\dot q)\,\mathrm{sgn}\,\hat\tau_{load}",
    columns=columns,
    parameters=(
        Parameter("half difference between driving and holding back", "{effort}"),
        Parameter("half difference between the flanks", "{effort}"),
    ),
    driver="load",
    excited_by="loads of both signs, raised and lowered slowly",
    source="Dohring, Lee, Newman 1993",
    confused_with=("load_friction", "back_driving_friction", "dead_time"),
    builds_on="load",
    dry_friction=True,
)
