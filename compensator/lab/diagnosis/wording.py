"""What a diagnosis says in words."""

from compensator.lab.chance import SIGNIFICANT, chance_in_words
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.note import Note
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.rows.dataset import BLOCK_S
from compensator.lab.screening.base import HYSTERESIS_DRIVER
from compensator.lab.screening.evidence import least_p_value, too_few_stretches

HALF = 0.5  # of the error's power
LOOK_AT_HOSES = "Look at hoses, cables and seals that bend with the joint."


def driver_in_words(driver: str) -> str:
    """What a residual varies with, as the page and reports have it: to people a velocity is a speed.

    Args:
        driver: as in a diagnosis: a variable, or one "against motion" or "times speed"; or the variable's title.
    """
    return "speed with its sign" if driver == "velocity" else driver.replace("velocity", "speed")


def missing_in_words(best: Candidate) -> str:
    """The answer where an effect is missing, with its numbers."""
    gain, where = best.gain.in_words(best.before, best.after), ", near reversals too," * (best.rows == "moving")
    return (
        f"{named_in_words(best, 'trials')}: adding it changes the held-out error{where} from {best.before:.2%} to "
        f"{best.after:.2%} ({gain}; {chance_in_words(best.p_value)})."
    )


def partly_in_words(best: Candidate) -> str:
    """A further sentence where more than noise is left beside an effect that explains less than half of the power."""
    explained = 1.0 - (1.0 - best.gain.value) ** 2
    if explained >= HALF:
        return ""
    return (
        f" It explains {explained:.0%} of the error's power, and what it leaves is more than noise: it may be the "
        "smaller effect of two, or stand for one that no formula has."
    )


def unknown_in_words(nearest: Candidate, driver: str, p_value: float) -> str:
    """The answer where what is left varies with a driver, and no formula follows that, nor does the nearest one."""
    why = "does not follow its curve" if nearest.physical else f"cannot be it: {nearest.impossible}"
    look = ""
    if driver == HYSTERESIS_DRIVER:
        driver, look = "where the joint has turned back, as what bends along and slides does", f" {LOOK_AT_HOSES}"
    return (
        f"Something is missing, and it is none of the catalogue: it varies with {driver_in_words(driver)}; the nearest "
        f"formula, {nearest.effect.in_sentence}, {why} ({chance_in_words(p_value)}).{look}"
    )


def nothing_in_words(p_value: float, stretches: int | None = None) -> str:
    """The answer where no effect is confirmed.

    Args:
        p_value: as in a diagnosis.
        stretches: independent stretches of BLOCK_S that it rests on; None where that is no limit.
    """
    if stretches is not None and too_few_stretches(stretches):
        return too_short_in_words(stretches)
    if p_value > SIGNIFICANT:
        chance = f"{chance_in_words(p_value)}; {SIGNIFICANT:g} or less would tell"
        return f"Nothing is missing that these trials can show ({chance})."
    return (
        f"No effect of the catalogue is confirmed: the residual is not mere noise ({chance_in_words(p_value)}), but "
        "none has all that a name needs."
    )


def helps_in_words(candidate: Candidate) -> Note:
    """What is no answer, as noise alone may look as strong, and lowers the error on other trials of these."""
    gain, effect = candidate.gain, candidate.effect
    told = f"({gain.in_words(candidate.before, candidate.after)}; {chance_in_words(candidate.p_value)})"
    text = (
        f"{effect.title} lowers the held-out error of these trials {told}, but noise alone may do as well: add it, and "
        "see whether later trials say the same."
    )
    return Note(
        "helps", text, {"effect": effect.name, "gain": gain.value, "gain_low": gain.low, "gain_high": gain.high}
    )


def nearest_in_words(nearest: Candidate) -> str:
    """What is likely where no effect is confirmed, and what would decide."""
    return (
        f"{nearest.effect.title} is likely ({nearest.gain.in_words(nearest.before, nearest.after)}), but it does not "
        f"help on other trials for sure; to decide, record more of: {nearest.effect.excited_by}."
    )


def named_in_words(best: Candidate, of: str) -> str:
    """That an effect is missing, and what it may be instead.

    Args:
        best: the effect.
        of: what cannot tell it from others: "trials", or "starts" from rest.
    """
    others = ", ".join(effect_named(name).in_sentence for name in best.rivals)
    return f"{best.effect.title} is missing" + (f"; these {of} cannot tell it from {others}" if others else "")


def too_short_in_words(stretches: int) -> str:
    """The answer where independent stretches are too few to tell whether anything is missing."""
    enough = next(count for count in range(1, 99) if not too_few_stretches(count))
    return (
        f"These trials are too short to tell whether anything is missing: only {stretches} independent stretches of "
        f"{BLOCK_S:g} s, at best {chance_in_words(least_p_value(stretches))}, and {SIGNIFICANT:g} is needed; record "
        f"{BLOCK_S * (enough - stretches):g} more seconds of motion at least; other loads and speeds tell most."
    )
