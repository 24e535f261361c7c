"""Whether what a diagnosis names is slight: next to nothing beside what effects that were added explain.

A formula is rarely right to more than a few per cent, and leaves what it is not right to. With enough rows that is
surely there, and some other effect of the catalogue follows it best; it is no reason to add that one.
"""

import math

from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis

SLIGHT_GAIN = 0.10  # of the held-out error, at the high end of its interval
SLIGHT_PART = 0.05  # of what effects that were added explain, root mean square: a formula is rarely right to more


def explained_part(before: float, after: float) -> float:
    """What took an error from one to the other, root mean square, in their unit; 0 where it rose."""
    return math.sqrt(max(0.0, before**2 - after**2))


def slight_one(found: Diagnosis, explained: float) -> Candidate | None:
    """What is named, where it is slight; None where nothing is named, or it is not slight.

    Args:
        found: the diagnosis.
        explained: by effects that were added to the first model, root mean square as a share of the effort, held out;
            with 0 nothing is slight.
    """
    if found.verdict != "missing" or not found.classes:
        return None
    one = next((each for each in found.candidates if each.effect.name == found.classes[0][0]), None)
    if one is None or one.gain.high >= SLIGHT_GAIN:
        return None
    return one if explained_part(one.before, one.after) < SLIGHT_PART * explained else None
