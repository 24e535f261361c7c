"""A free curve over a measured variable: a provisional term, for what is missing and has no formula yet.

It names a variable, not a mechanism: it fills the gap in the model until somebody knows the physics. The curve is
linear between seven knots, and zero at the first, where offset (or Coulomb friction, for one against the motion) holds;
after a reversal at the last, since Coulomb friction is what holds far from there.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

PREFIX, FORCE, AGAINST_MOTION, TIMES_SPEED = "curve_of_", "", " against motion", " times speed"
KNOTS = 7
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh")


@dataclass(frozen=True, slots=True)
class _Variable:
    """A variable: its values at the full rate, and what of a model's prediction they are made of."""

    title: str
    of: Callable[[Motion], FloatArray]
    builds_on: Literal["load", "effort"] | None = None
    rows: Literal["sliding", "moving"] = "sliding"

    @property
    def zero_at(self) -> int:
        """The knot at which its curves are zero."""
        return KNOTS - 1 if self.rows == "moving" else 0


_VARIABLES = {
    "position": _Variable("position", lambda motion: motion.place),
    "velocity": _Variable("velocity", lambda motion: motion.velocity),
    "speed": _Variable("speed", lambda motion: np.abs(motion.velocity)),
    "acceleration": _Variable("acceleration", lambda motion: motion.acceleration),
    "load": _Variable("the predicted load", lambda motion: motion.load_effort, "load"),
    "load_kg": _Variable("the load at the tip", lambda motion: np.full(len(motion.time_s), motion.load_kg)),
    "temperature": _Variable("temperature", lambda motion: motion.temperature_c),
    "time": _Variable("the time in the trial", lambda motion: motion.time_s),
    "session_time": _Variable("the time in the session", lambda motion: motion.session_s),
    "since_reversal": _Variable(
        "the travel since the last reversal", lambda motion: motion.strokes.travel, rows="moving"
    ),
}


WAYS: dict[str, Callable[[Motion], FloatArray | float]] = {
    FORCE: lambda _: 1.0,
    AGAINST_MOTION: lambda motion: motion.direction,
    TIMES_SPEED: lambda motion: motion.velocity,
}
"""How a curve acts: as a force, as dry friction does, or as damping does; by the end of its name."""

_DAMPED = ("position", "load")  # what oil between surfaces may differ with, beside its temperature


def ways_of(variable: str) -> tuple[str, ...]:
    """In which ways what goes by a variable may act."""
    return tuple(way for way in WAYS if way != TIMES_SPEED or variable in _DAMPED)


def way_of(name: str) -> tuple[str, str]:
    """The variable of a curve and its way, by a name as effects or blocks have it."""
    spoken = name.removeprefix(PREFIX)
    way = next((way for way in (AGAINST_MOTION, TIMES_SPEED) if spoken.endswith((way, _spelt(way)))), FORCE)
    return spoken.removesuffix(way).removesuffix(_spelt(way)), way


def _spelt(way: str) -> str:
    return way.replace(" ", "_")


def name_of(driver: str) -> str | None:
    """The curve over what a diagnosis says that the residual varies with; None where there is none.

    Args:
        driver: as `Diagnosis.driver`: a variable, or one "against motion" or "times speed".
    """
    variable, way = way_of(driver)
    if variable not in _VARIABLES:
        return None
    if variable == "velocity" and way:
        variable = "speed"  # friction the same both ways: what differs by direction has names, and shows beside it
    # what comes up after a reversal is friction, whether that is said or not
    return f"{PREFIX}{variable}{_spelt(AGAINST_MOTION if variable == 'since_reversal' else way)}"


@cache
def free_curve(name: str) -> Effect | None:
    """The curve of this name; None where it is not the name of one."""
    variable, way = way_of(name)
    return _curve(name, variable, way) if name in known() else None


def known() -> list[str]:
    """Names of all curves."""
    return [f"{PREFIX}{name}{_spelt(way)}" for name in _VARIABLES for way in ways_of(name)]


def _curve(name: str, variable: str, way: str) -> Effect:
    over = _VARIABLES[variable]
    words, factor, unit = {
        FORCE: ("", "", "{effort}"),
        AGAINST_MOTION: (", against the motion", r"\,\mathrm{sgn}\,\dot q", "{effort}"),
        TIMES_SPEED: (", times the speed", r"\,\dot q", "{effort} s/{position}"),
    }[way]
    return Effect(
        name=name,
        title=f"Curve over {over.title}{words}",
        physics=(
            "Nobody knows yet: a curve that fills the gap, as measured. It holds within the range that the trials "
            "cover, and says which variable to look at, not why."
        ),
        equation=rf"f(x){factor}",
        columns=lambda motion, knots: _hats(over.of(motion), knots, over.zero_at) * WAYS[way](motion),
        parameters=tuple(Parameter(f"at the {one} knot", unit) for one in np.delete(_ORDINALS, over.zero_at)),
        driver=variable,
        excited_by=f"trials over the whole range of {over.title}",
        source="a linear spline: model-error modelling (Ljung 1999)",
        shapes=lambda motion: [_knots([motion], over)],
        shape_over=lambda motions: _knots(motions, over),
        shape_names=tuple(f"{one} knot" for one in _ORDINALS),
        shape_units=("as the variable",) * KNOTS,
        channels=("temperature_c",) if variable == "temperature" else (),
        varies_with="session_s" if variable == "session_time" else None,
        builds_on=over.builds_on,
        rows=over.rows,
        provisional=True,
    )


def _knots(motions: Sequence[Motion], over: _Variable) -> Shape:
    """Quantiles of the variable over all motion; evenly spaced where it has a few values only."""
    moving = [np.abs(motion.velocity) > motion.slow for motion in motions]
    values = np.concatenate([over.of(motion)[moves] for motion, moves in zip(motions, moving, strict=True)])
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return tuple(np.arange(float(KNOTS)))
    places = np.quantile(values, np.linspace(0.0, 1.0, KNOTS))
    if np.diff(places).min() <= 1e-6 * (np.ptp(places) + 1e-12):
        places = np.linspace(places[0], places[-1] if places[-1] > places[0] else places[0] + 1.0, KNOTS)
    return tuple(places.tolist())


def _hats(values: FloatArray, knots: Shape, zero_at: int) -> FloatArray:
    """Linear hats on all knots but one, shape (k, n); the outer ones go on beyond their knots."""
    return np.array([np.interp(values, knots, unit) for unit in np.delete(np.eye(len(knots)), zero_at, axis=0)])
