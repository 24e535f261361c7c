"""Joint elasticity."""

from compensator.lab.differentiation import rate_of_change
from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Second rate of change of the transmitted load, against it; the first order in the compliance."""
    rate = 1.0 / (motion.time_s[1] - motion.time_s[0])
    return -rate_of_change(rate_of_change(motion.load_effort, rate), rate)[None]


EFFECT = Effect(
    name="elasticity",
    title="Joint elasticity",
    physics=(
        "Gear and shaft twist under the load they carry: the arm lags behind the motor, and below the first "
        "resonance the motor's effort falls short in proportion to the second rate of change of the load."
    ),
    equation=r"-\frac{J_a}{k}\,\ddot{\hat\tau}_{load}",
    columns=columns,
    parameters=(Parameter("inverse square of the anti-resonance", "s2", 0.0),),
    driver="acceleration",
    excited_by="fast motion with a load: frequencies up to a third of the anti-resonance",
    source="Spong 1987; Janot, Gautier, Brunot 2019",
    confused_with=("measurement_delay", "inertia"),
    builds_on="load",
    rows="moving",
)
