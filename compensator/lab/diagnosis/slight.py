"""Whether what a diagnosis names is next to nothing beside what was added before."""

import math

from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Effect

SLIGHT_GAIN = 0.10  # of the held-out error, at the high end of its interval
SLIGHT_PART = 0.05  # of what effects that were added explain, root mean square: a formula is rarely right to more


def slight_one(diagnosis: Diagnosis, explained: float) -> Candidate | None:
    """What is named, where it is next to nothing beside what was added; None where it is not slight.

    A formula leaves what it is not right to. With enough rows that is surely there, and some other effect follows
    it best; it is no reason to add that one.

    Args:
        diagnosis: that names it.
        explained: by effects that were added to the first model, root mean square as a share of the effort, held
            out; with 0 nothing is slight.
    """
    if diagnosis.verdict != "missing" or not diagnosis.classes:
        return None
    one = next((each for each in diagnosis.candidates if each.effect.name == diagnosis.classes[0][0]), None)
    if one is None or one.gain.high >= SLIGHT_GAIN or _opens_others(one.effect):
        return None
    return one if explained_part(one.before, one.after) < SLIGHT_PART * explained else None


def _opens_others(effect: Effect) -> bool:
    """Whether it is of the measuring chain, and others cannot be judged before it is in the model, as a filter."""
    return effect.pipeline and any(effect.name in other.after for other in catalogue().values())


def explained_part(before: float, after: float) -> float:
    """What took an error from one to the other, root mean square, in their unit; 0 where it rose."""
    return math.sqrt(max(0.0, before**2 - after**2))
