"""Weight-dependent Stribeck effect."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.effects.friction.speed import stribeck
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Mass of the load times the excess of static over Coulomb friction, for shape (v_s, delta)."""
    return motion.load_kg * stribeck.columns(motion, shape)


EFFECT = Effect(
    name="weight_stribeck",
    title="Weight-dependent Stribeck effect",
    physics=(
        "Where friction grows with the weight that the axis carries, what static friction is more than Coulomb "
        "friction grows with it: the paper's curves have another static friction for each load."
    ),
    equation=r"c_s\,m\,e^{-|\dot q/v_s|^{\delta}}\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(Parameter("static minus Coulomb friction per load", "{effort}/kg", 0.0),),
    driver="velocity",
    excited_by="several loads in slow motion: many rows below and around the Stribeck speed",
    source="Saini et al. 2013, section 3.2 and Figs 2, 7",
    shapes=stribeck.shapes,
    smooth_shape=True,
    shape_names=stribeck.EFFECT.shape_names,
    shape_units=stribeck.EFFECT.shape_units,
    confused_with=("stribeck", "weight_friction"),
    varies_with="load_kg",
    dry_friction=True,
    after=("stribeck", "weight_friction"),
)
