"""Whether a coefficient of friction is another one at another load, temperature or time of the session.

A curve over temperature, say, is one for all speeds, and so is dry friction that follows it. A lubricant that thins
changes what grows with the speed: that is the model's own column times the variable, a coefficient that varies (Hastie,
Tibshirani 1993). Where a name imitates it in part, as warm-up does, no curve over one variable is left.

Loads, temperatures and times are of the trial, not of the motion, so that nothing of a reversal follows them. What the
arm weighs is not asked: loads are not weighed so well.

Friction of each trial is another one, and noise that is learnt without what follows a condition of the trials has
hardly any of that: what is looked at again against such noise seems too sure. So nothing is where a model has all that
every joint has, and nothing else speaks for a cause that it lacks; beside a name one is missing for sure.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.left_over.white_rows import FORETOLD, WhiteRows
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates

FRICTION = ("coulomb", "stribeck", "viscous")  # what every joint has of it
CONDITIONS: dict[str, Callable[[Motion], FloatArray]] = {
    "load": lambda motion: np.full(len(motion.time_s), motion.condition("load_kg", 0.0)),
    "temperature": lambda motion: motion.temperature_c,
    "time in the session": lambda motion: motion.session_s,
}
SAME = 1e-9  # of a condition, relative: that is no difference


@dataclass(frozen=True, slots=True)
class Varying:
    """A coefficient that varies with a condition.

    Attributes:
        effect: whose coefficient it is, by its title.
        condition: that it varies with.
        chance: of so much in noise alone, over all coefficients and conditions.
        foretold: evidence (2 ln L) in each stretch by all others, without the best stretch.
    """

    effect: str
    condition: str
    chance: float
    foretold: float

    def is_there(self, most: float) -> bool:
        """Whether it is no noise, by the chance up to which it is none, nor of one stretch."""
        return self.chance <= most and self.foretold >= FORETOLD


def varying_of(gathered: Candidates, white: WhiteRows, most: float) -> Varying | None:
    """The coefficient of friction that varies most surely; None where none does for sure, or by next to nothing.

    Args:
        gathered: the model.
        white: its rows.
        most: chance in noise alone up to which it is none.
    """
    asked = {
        (effect, condition): (share * values)[gathered.rows, None] * white.weights[:, None]
        for condition, values in _conditions(gathered.fit, gathered.rows).items()
        for effect, share in _friction(gathered.fit).items()
    }
    found = [(_varying(of, white, columns, len(asked)), columns) for of, columns in asked.items()]
    if not found:
        return None
    best, columns = min(found, key=lambda one: one[0].chance)
    return best if best.is_there(most) and white.is_large(gathered, columns) else None


def _varying(of: tuple[str, str], white: WhiteRows, columns: FloatArray, tries: int) -> Varying:
    """How surely a coefficient varies, by its weighted column (n, 1), one of so many."""
    fresh = white.new(columns)
    if fresh.shape[1] == 0:
        return Varying(*of, 1.0, 0.0)
    chance = tries * white.noise.chance(float(np.sum((white.residual @ fresh) ** 2)), fresh.shape[1])
    return Varying(*of, min(1.0, chance), white.foretold(fresh)[1])


def _friction(fit: Fit) -> dict[str, FloatArray]:
    """What each effect of friction that every joint has adds to the effort, by its title, shape (N,)."""
    found, at = {}, 0
    for term in fit.terms:
        own = slice(at, at + len(term.coefficients))
        at = own.stop
        if term.effect.name in FRICTION and np.any(term.coefficients):
            found[term.effect.title] = fit.columns[:, own] @ term.coefficients
    return found


def _conditions(fit: Fit, rows: "np.ndarray[tuple[int], np.dtype[np.bool_]]") -> dict[str, FloatArray]:
    """Every condition that differs over the rows (N,), about its mean there and in its own deviations, shape (N,)."""
    found = {}
    for name, of in CONDITIONS.items():
        values = fit.dataset.rows_of([of(trial.motion) for trial in fit.dataset.trials])
        own = values[rows]
        if np.isfinite(values).all() and np.ptp(own) > SAME * (1.0 + np.abs(own).max()):
            found[name] = (values - own.mean()) / own.std()
    return found


def varying_in_words(varying: Varying) -> str:
    """Whose coefficient is another one, and at what."""
    return f"has the form of {varying.effect.lower()} that varies with {varying.condition}"
