"""Whether an effect, or a curve, is confirmed by its evidence and its gain on held-out rows, and is worth adding."""

import math
from collections.abc import Sequence

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.model.fit import with_columns
from compensator.lab.model.gain import held_out_gain
from compensator.lab.model.held_out_error import LEAST_OF_EFFORT, HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import VERY_STRONG, Evidence, Screening, among_all

SLIGHT_GAIN = 0.10  # of the held-out error, at the high end of its interval
SLIGHT_PART = 0.05  # of what effects that were added explain, root mean square: a formula is rarely right to more
LEAST_GAIN = 0.005  # a smaller fall of the held-out error is of no use, however sure it is
UNSURE_GAIN = "gain not sure"
UNPAID, LUCK = "score not above 0", "may be luck"  # what noise alone may do as well
LEAST_GAIN_NEAR_REVERSALS = 0.02  # twice what effects with memory gain, surely, on joints that lack nothing
LEAST_GAIN_OF_CHAIN = 0.05  # every measuring chain bends a little, and is a little late


def is_confirmed(candidate: Candidate) -> bool:
    """Whether the evidence pays for its parameters, and neither it nor the gain on held-out rows is luck.

    What explains nothing unless it is larger, smaller, or of the other sign than it can be, is the shadow of something
    else.
    """
    return not doubts(candidate)


def doubts(candidate: Candidate) -> list[str]:
    """Why a candidate is not confirmed, in words; none where it is."""
    before, gain = candidate.before, candidate.gain
    explained = before**2 * (1.0 - (1.0 - gain.value) ** 2)
    least = LEAST_GAIN if candidate.effect.rows == "sliding" else LEAST_GAIN_NEAR_REVERSALS
    least = LEAST_GAIN_OF_CHAIN if candidate.effect.standing_in else least
    asked = {
        UNPAID: candidate.score > 0.0,
        LUCK: candidate.p_value <= SIGNIFICANT,
        f"explains under {LEAST_OF_EFFORT:.2%} of the effort": explained >= LEAST_OF_EFFORT**2,
        f"gain under {least:.1%}": gain.value >= least,
        UNSURE_GAIN: gain.low > 0.0,
    }
    told = [reason for reason in (candidate.impossible, candidate.refused) if reason]
    return [doubt for doubt, holds in asked.items() if not holds] + told


def nearest_one(candidates: Sequence[Candidate]) -> Candidate | None:
    """Of effects that are no luck and not sure to help, that with the most evidence; None without."""
    near = [one for one in candidates if one.score > VERY_STRONG and doubts(one) == [UNSURE_GAIN]]
    return max(near, key=lambda one: one.score, default=None)


def helps_unproved(candidate: Candidate) -> bool:
    """Whether it lowers the held-out error for sure, by more than every measuring chain bends, and may yet be luck."""
    found = set(doubts(candidate))
    return bool(found) and found <= {UNPAID, LUCK} and candidate.gain.low >= LEAST_GAIN_OF_CHAIN


def helpful_curve(gathered: Candidates, generic: Screening) -> tuple[Evidence, HeldOut] | None:
    """The free curve with the best evidence, and the held-out error with it; None where it is luck, or hardly helps.

    It has more coefficients than a formula, and every chain bends a little of what it measures.

    Args:
        gathered: the model, and what it may be missing.
        generic: evidence for free curves.
    """
    curve = next((one for one in generic.evidence[:1] if one.score > 0.0), None)
    if curve is None or among_all(generic.chance(curve.p_value)) > SIGNIFICANT:
        return None
    fit, name = gathered.fit, curve.block.name
    errors = held_out(with_columns(fit, name, gathered.curves.columns[name]))
    return (curve, errors) if is_helpful(held_out(fit), errors) else None


def is_helpful(before: HeldOut, after: HeldOut) -> bool:
    """Whether a curve lowers the held-out error for sure, and by more than what every measuring chain bends."""
    gain = held_out_gain(before, after)
    notable = explained_part(before.relative, after.relative) >= LEAST_OF_EFFORT
    return notable and gain.low > 0.0 and gain.value >= LEAST_GAIN_OF_CHAIN


def slight_one(diagnosis: Diagnosis, explained: float) -> Candidate | None:
    """What is named, where it is next to nothing beside what was added; None where it is not slight.

    A formula leaves what it is not right to. With enough rows that is surely there, and some other effect follows
    it best; it is no reason to add that one.

    Args:
        diagnosis: that names it.
        explained: by effects that were added to the first model, root mean square as a share of the effort, held
            out; with 0 nothing is slight.
    """
    if diagnosis.verdict != "missing":
        return None
    one = next((each for each in diagnosis.candidates if each.effect.name == diagnosis.classes[0][0]), None)
    if one is None or one.gain.high >= SLIGHT_GAIN:
        return None
    return one if explained_part(one.before, one.after) < SLIGHT_PART * explained else None


def explained_part(before: float, after: float) -> float:
    """What took an error from one to the other, root mean square, in their unit; 0 where it rose."""
    return math.sqrt(max(0.0, before**2 - after**2))
