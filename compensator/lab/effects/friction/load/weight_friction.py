"""Weight-dependent friction."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Mass of the load against the motion."""
    return (motion.load_kg * motion.direction)[None]


PARAMETERS = (Parameter("Coulomb friction per load", "{effort}/kg", 0.0),)

EFFECT = Effect(
    name="weight_friction",
    title="Weight-dependent friction",
    physics=(
        "Bearing friction that grows with the weight that the axis carries, whatever its angle: balanced "
        "loads rub as well."
    ),
    equation=r"c\,m\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=PARAMETERS,
    driver="load_kg",
    excited_by="several loads, also balanced ones",
    source="Saini et al. 2013, section 3.2 and Figs 3, 7",
    confused_with=("load_friction", "coulomb"),
    varies_with="load_kg",
    breakaway=at_rest(columns, PARAMETERS, "load_kg"),
    dry_friction=True,
)
