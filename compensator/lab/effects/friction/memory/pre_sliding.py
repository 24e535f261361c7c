"""Pre-sliding displacement."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.reversals import deflection


def shapes(motion: Motion) -> list[Shape]:
    """Distances from a ten-thousandth to a tenth of the travel: a gear gives by some hundredths of a degree."""
    return [(float(share * motion.position_span),) for share in np.geomspace(1e-4, 0.1, 10)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What friction lacks while the surfaces still give, for shape (x_s,)."""
    strokes = motion.strokes
    return (deflection(strokes, shape[0]) - strokes.sign[strokes.index])[None]


EFFECT = Effect(
    name="pre_sliding",
    title="Pre-sliding",
    physics=(
        "Before surfaces slide they give like springs: after a reversal friction comes up over a distance "
        "instead of at once. Dahl's law, to be had from the position alone. All of the dry friction comes up like "
        "that: where a part of it does, something else bends, as a hose or a cable."
    ),
    equation=r"F_p\,(z - \mathrm{sgn}\,\dot q),\quad x_s\,dz = (1 - z\,\mathrm{sgn}\,\dot q)\,dq",
    columns=columns,
    parameters=(Parameter("friction that comes up over a distance", "{effort}", 0.0),),
    driver="since_reversal",
    excited_by="many reversals, with strokes shorter and longer than the distance",
    source="Dahl 1968; Armstrong, Dupont, Canudas de Wit 1994",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("pre-sliding distance",),
    shape_units=("{position}",),
    confused_with=("backlash", "frictional_lag", "measurement_delay"),
    rows="moving",
    standing_in=frozenset({"stiff_contact"}),
    least_of_friction=0.5,
    ends_within_scan=1,
)
