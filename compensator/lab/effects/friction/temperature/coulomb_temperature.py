"""Temperature-dependent Coulomb friction."""

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray

REFERENCE_C = 25.0  # where the plain Coulomb coefficient holds


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Direction times temperature above the reference."""
    return ((motion.temperature_c - REFERENCE_C) * motion.direction)[None]


PARAMETERS = (Parameter("Coulomb friction per kelvin", "{effort}/K"),)

EFFECT = Effect(
    name="coulomb_temperature",
    title="Temperature-dependent Coulomb friction",
    physics=("Clearances and boundary films change as the gear warms: Coulomb friction changes with temperature."),
    equation=r"F_{cT}\,(T - T_0)\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=PARAMETERS,
    driver="temperature",
    excited_by="the same slow motion cold and warm, cold and warm interleaved",
    source="Bittencourt et al. 2010",
    channels=("temperature_c",),
    confused_with=("viscous_temperature",),
    varies_with="temperature_c",
    breakaway=at_rest(columns, PARAMETERS, "temperature"),
    dry_friction=True,
)
