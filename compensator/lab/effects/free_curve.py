"""A free curve over a measured variable: a provisional term, for what is missing and has no formula yet.

It names a variable, not a mechanism: it fills the gap in the model until somebody knows the physics. The curve is
linear between seven knots, and zero at the first, where offset (or Coulomb friction, for one against the motion) holds.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

PREFIX, AGAINST_MOTION = "curve_of_", "_against_motion"
KNOTS = 7
_ORDINALS = ("second", "third", "fourth", "fifth", "sixth", "seventh")


@dataclass(frozen=True, slots=True)
class _Variable:
    """A variable: its values at the full rate, and what of a model's prediction they are made of."""

    title: str
    of: Callable[[Motion], FloatArray]
    builds_on: Literal["load", "effort"] | None = None
    rows: Literal["sliding", "moving"] = "sliding"


_VARIABLES = {
    "position": _Variable("position", lambda motion: motion.place),
    "velocity": _Variable("velocity", lambda motion: motion.velocity),
    "speed": _Variable("speed", lambda motion: np.abs(motion.velocity)),
    "acceleration": _Variable("acceleration", lambda motion: motion.acceleration),
    "load": _Variable("the predicted load", lambda motion: motion.load_effort, "load"),
    "load_kg": _Variable("the load at the tip", lambda motion: np.full(len(motion.time_s), motion.load_kg)),
    "temperature": _Variable("temperature", lambda motion: motion.temperature_c),
    "time": _Variable("the time in the trial", lambda motion: motion.time_s),
    "since_reversal": _Variable(
        "the travel since the last reversal", lambda motion: motion.strokes.travel, rows="moving"
    ),
}


def name_of(driver: str) -> str | None:
    """The curve over what a diagnosis says that the residual varies with; None where there is none.

    Args:
        driver: as `Diagnosis.driver`: a variable, or one "against motion".
    """
    variable, against, _ = driver.partition(" against motion")
    if variable not in _VARIABLES:
        return None
    if variable == "velocity" and against:
        variable = "speed"  # friction the same both ways: what differs by direction has names, and shows beside it
    # what comes up after a reversal is friction, whether that is said or not
    return f"{PREFIX}{variable}{AGAINST_MOTION if against or variable == 'since_reversal' else ''}"


@cache
def free_curve(name: str) -> Effect | None:
    """The curve of this name; None where it is not the name of one."""
    variable = name.removeprefix(PREFIX).removesuffix(AGAINST_MOTION)
    if not name.startswith(PREFIX) or variable not in _VARIABLES:
        return None
    return _curve(name, variable, name.endswith(AGAINST_MOTION))


def known() -> list[str]:
    """Names of all curves."""
    return [f"{PREFIX}{name}{way}" for name in _VARIABLES for way in ("", AGAINST_MOTION)]


def _curve(name: str, variable: str, against: bool) -> Effect:
    over = _VARIABLES[variable]
    sign = r"\,\mathrm{sgn}\,\dot q" if against else ""
    return Effect(
        name=name,
        title=f"Curve over {over.title}{', against the motion' if against else ''}",
        physics=(
            "Nobody knows yet: a curve that fills the gap, as measured. It holds within the range that the trials "
            "cover, and says which variable to look at, not why."
        ),
        equation=rf"f(x){sign}",
        columns=lambda motion, knots: _hats(over.of(motion), knots) * (motion.direction if against else 1.0),
        parameters=tuple(Parameter(f"at the {one} knot", "{effort}") for one in _ORDINALS),
        driver=variable,
        excited_by=f"trials over the whole range of {over.title}",
        source="a linear spline: model-error modelling (Ljung 1999)",
        shapes=lambda motion: [_knots([motion], over)],
        shape_over=lambda motions: _knots(motions, over),
        shape_names=tuple(f"{one} knot" for one in ("first", *_ORDINALS)),
        shape_units=("as the variable",) * (len(_ORDINALS) + 1),
        channels=("temperature_c",) if variable == "temperature" else (),
        builds_on=over.builds_on,
        rows=over.rows,
        provisional=True,
    )


def _knots(motions: Sequence[Motion], over: _Variable) -> Shape:
    """Quantiles of the variable over all trials; evenly spaced where it has a few values only."""
    values = np.concatenate([over.of(motion) for motion in motions])
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return tuple(np.arange(float(KNOTS)))
    places = np.quantile(values, np.linspace(0.0, 1.0, KNOTS))
    if np.diff(places).min() <= 1e-6 * (np.ptp(places) + 1e-12):
        places = np.linspace(places[0], places[-1] if places[-1] > places[0] else places[0] + 1.0, KNOTS)
    return tuple(places.tolist())


def _hats(values: FloatArray, knots: Shape) -> FloatArray:
    """Linear hats on all knots but the first, shape (k, n); the outer one goes on beyond its knot."""
    return np.array([np.interp(values, knots, unit) for unit in np.eye(len(knots))[1:]])
