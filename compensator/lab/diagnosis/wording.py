"""What a diagnosis says in words."""

from collections.abc import Sequence

from compensator.lab.chance import chance_in_words
from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.examination import SIGNIFICANT
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.left_over.bursts import Bursts
from compensator.lab.left_over.constancy import Change
from compensator.lab.left_over.constants import DRY_FRICTION
from compensator.lab.left_over.left_over import LeftOver
from compensator.lab.left_over.orders import Line
from compensator.lab.left_over.swinging import Swing
from compensator.lab.left_over.varying import Varying
from compensator.lab.left_over.wandering import Wandering
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.dataset import BLOCK_S
from compensator.lab.screening.evidence import least_p_value
from compensator.lab.screening.generic import HYSTERESIS_DRIVER as HYSTERESIS

MOST_NAMES = 3
LOOK_AT_HOSES = "Look at hoses, cables and seals that bend with the joint."


def answer_in_words(
    verdict: Verdict, p_value: float, candidates: list[Candidate], driver: str | None, stretches: int | None = None
) -> str:
    """The answer in one sentence, with its numbers.

    Args:
        verdict: as in a diagnosis.
        p_value: as in a diagnosis.
        candidates: as in a diagnosis.
        driver: as in a diagnosis.
        stretches: independent stretches of BLOCK_S that it rests on; None where that is no limit.
    """
    if verdict == "nothing" and stretches is not None and least_p_value(stretches) > SIGNIFICANT:
        return _too_few(stretches)
    if verdict == "nothing":
        return _nothing(p_value)
    best = candidates[0]
    if verdict == "unknown-effect":
        why = "does not follow its curve" if best.physical else "would need a sign or size that is not physical"
        look = ""
        if driver == HYSTERESIS:
            driver, look = "where the joint has turned back, as what bends along and slides does", f" {LOOK_AT_HOSES}"
        return (
            f"Something is missing, and it is none of the catalogue: it varies with {driver}; the nearest formula, "
            f"{best.effect.title.lower()}, {why} ({chance_in_words(p_value)}).{look}"
        )
    gain = best.gain.in_words(best.before, best.after, 0)
    sure = "" if best.gain.low > 0.0 else ", but not for sure"
    return (
        f"{named_in_words(best, 'trials')}: adding it changes the held-out error from {best.before:.2%} to "
        f"{best.after:.2%}{sure} ({gain}; {chance_in_words(p_value)})."
    )


def named_in_words(best: Candidate, of: str) -> str:
    """That an effect is missing, or likely, where its gain on other trials is not sure; and what it may be instead.

    Args:
        best: the effect.
        of: what cannot tell it from others: "trials", or "starts" from rest.
    """
    missing = "is missing" if best.gain.low > 0.0 else "is likely missing"
    others = ", ".join(effect_named(name).title.lower() for name in best.rivals)
    return f"{best.effect.title} {missing}" + (f"; these {of} cannot tell it from {others}" if others else "")


def problem_in_words(problem: str) -> str:
    """The answer where the data themselves are wrong."""
    return f"The data have a problem that no effect could be told from: {problem}."


def _too_few(stretches: int) -> str:
    enough = next(count for count in range(1, 99) if least_p_value(count) <= SIGNIFICANT)
    return (
        f"These trials are too short to tell whether anything is missing: only {stretches} independent stretches of "
        f"{BLOCK_S:g} s, at best {chance_in_words(least_p_value(stretches))}, and {SIGNIFICANT:g} is needed; record "
        f"{BLOCK_S * (enough - stretches):g} more seconds of motion at least; other loads and speeds tell most."
    )


def _nothing(p_value: float) -> str:
    if p_value > SIGNIFICANT:
        chance = f"{chance_in_words(p_value)}; {SIGNIFICANT:g} or less would tell"
        return f"Nothing is missing that these trials can show ({chance})."
    return (
        f"No effect of the catalogue is confirmed: the residual is not mere noise ({chance_in_words(p_value)}), but "
        "none lowers the held-out error for sure."
    )


def unexplained_in_words(
    left: LeftOver, driver: str | None, p_value: float, stretches: int, facts: Facts, wanders: str = ""
) -> str:
    """The answer where something is left that no effect and no curve explains.

    Args:
        left: what it is.
        driver: that it varies with most; None where it varies with none.
        p_value: as in a diagnosis.
        stretches: independent stretches of BLOCK_S that it rests on.
        facts: of the joint.
        wanders: what is another one for seconds, in words; empty where nothing is.
    """
    none = f"No effect of the catalogue is confirmed ({chance_in_words(p_value)})"
    if least_p_value(stretches) > SIGNIFICANT:
        none = f"{stretches} stretches of {BLOCK_S:g} s are too few to name an effect"
    if left.change is not None:
        how = changing_in_words(left.change)
    elif left.line is not None and (left.following is None or left.line.chance <= left.following.chance):
        how = f"it {recurring_in_words(left.line, facts)}"
    elif left.swing is not None:
        how = f"it {swinging_in_words(left.swing)}"
    elif wanders:
        how = wanders
    elif left.varying is not None and left.following is None:
        how = f"it {varying_in_words(left.varying)}"
    elif driver is not None or left.following is not None:
        named = driver if left.following is None else left.following.driver
        how = f"it varies with {named}, most of all that is measured"
    else:
        how = "it varies with nothing that is measured"
    return (
        f"{none}, yet what is left, {left.remainder.share:.1%} of the effort, is more than noise; {how}. "
        "Repeat a trial: what comes again is the joint's, what does not has changed since."
    )


def recurring_in_words(line: Line, facts: Facts) -> str:
    """What comes back with the position, how often, and where to look."""
    per = "a turn of the joint" if facts.joint == "rotary" else f"per {facts.position_unit}"
    way = ", against the motion" if line.against_motion else ", and grows with the speed" if line.growing else ""
    return f"comes back with the position about {line.order:.3g} times {per}{way}: look at what goes round so often"


def varying_in_words(varying: Varying) -> str:
    """Whose coefficient is another one, and at what."""
    return f"has the form of {varying.effect.lower()} that varies with {varying.condition}"


def swinging_in_words(swing: Swing) -> str:
    """What most trials share, and where to look."""
    where = "with the voltage: look at the supply" if swing.of_voltage else "in most trials: look at what turns"
    return f"swings at about {swing.frequency_hz:.2g} Hz {where}"


def changing_in_words(change: Change) -> str:
    """What is not as constant as the model takes it for."""
    return f"{change.what} changes from one stretch of {BLOCK_S:g} s to the next, by {change.share:.1%} of the effort"


def wandering_in_words(wandering: Wandering, trials: Sequence[str], unit: str) -> str:
    """What is another one for seconds, by how much, and where to look for that."""
    moments = " and ".join(f"{trials[index]} at {at_s:.1f} s" for index, at_s in wandering.changes)
    of = "it" if wandering.what == DRY_FRICTION else "the effort"
    if wandering.jumps:
        return (
            f"{wandering.what} jumps between two values, {wandering.size:.2g} {unit} apart, {wandering.share:.1%} of "
            f"{of}; most of all in {moments}"
        )
    return (
        f"{wandering.what} is another one for seconds at a time, by {wandering.size:.2g} {unit}, {wandering.share:.1%} "
        f"of {of}; it changes most in {moments}"
    )


def bending_in_words(bends: Candidate, too_far: bool, facts: Facts, p_value: float) -> str:
    """The answer where something comes up over a distance after a reversal that is not the friction itself."""
    least = " or more" if too_far else ""
    why = "is too far" if too_far else "is too small a part of the dry friction"
    return (
        "Something is missing, and it is none of the catalogue: it varies with the travel since the last reversal, "
        f"over some {bends.shape[0]:.2g} {facts.position_unit}{least}, and {why} for "
        f"surfaces that give before they slide ({chance_in_words(p_value)}; with such a curve the held-out error would "
        f"fall from {bends.before:.2%} to {bends.after:.2%}). {LOOK_AT_HOSES}"
    )


def some_of(names: Sequence[str]) -> str:
    """The first few of them, and how many more there are."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def bursts_in_words(bursts: Bursts, trials: Sequence[str], p_value: float) -> str:
    """The answer where a few stretches leave far more than the others."""
    return (
        f"No effect of the catalogue is confirmed ({chance_in_words(p_value)}), yet what is left, "
        f"{bursts.of_effort:.1%} of the effort, comes in bursts: {bursts.stretches} of {bursts.of} stretches of "
        f"{BLOCK_S:g} s scatter up to {bursts.largest:.1f} times as much as the others, in {some_of(trials)}. "
        "Something slips, skips or catches there: look at couplings, clutch and cables, and repeat one of these "
        "trials with less load."
    )
