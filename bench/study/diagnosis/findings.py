"""What a diagnosis found, with codes: the one place where the lab's answer becomes codes, numbers and words."""

from collections.abc import Sequence

from bench.study.models.diagnosis import Conclusion, ConclusionCode, Finding, FindingCode, Joint, Ranked, Value
from compensator.lab.chance import SIGNIFICANT, stated
from compensator.lab.diagnosis.confirmation import nearest_one
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain
from compensator.lab.model.validation import few_trials

RECORDED_ONCE = "This joint was drawn for a challenge and recorded once: what would take further trials cannot be had."


def conclusion_of(found: Diagnosis) -> Conclusion:
    """The answer itself."""
    return Conclusion(code=_code(found), values=_values(found), text=found.sentence)


def findings_of(found: Diagnosis) -> list[Finding]:
    """What stands beside the answer: problems of the data that it does not tell itself, notes, effects not judged."""
    # where the data are wrong, a problem is the answer itself
    untold = [problem for problem in found.data_problems if problem not in found.sentence]
    return [
        *(Finding(code="data-problem", values={}, text=problem) for problem in untold),
        *(Finding(code=note.code, values=dict(note.values), text=note.text) for note in found.notes),
        *(not_judged(effect, reason) for effect, reason in found.left_out.items()),
    ]


def findings_of_trials(fit: Fit, joint: Joint) -> list[Finding]:
    """What stands beside every answer on these trials: too few to leave one out, or of a joint recorded once."""
    told: dict[FindingCode, str] = {
        "few-trials": few_trials(fit),
        "recorded-once": RECORDED_ONCE if joint == "nowhere" else "",
    }
    return [Finding(code=code, values={}, text=text) for code, text in told.items() if text]


def not_judged(effect: str, reason: str) -> Finding:
    """An effect that these trials cannot show."""
    return Finding(code="not-judged", values={"effect": effect, "reason": reason}, text=f"Not judged: {reason}.")


def numbers_explained(ranking: Sequence[Ranked]) -> str:
    """What a reader of the ranking's errors and gains would stumble over; empty where there is nothing."""
    told = []
    if any(_gain(one).is_unlike(one.held_out_before, one.held_out_after) for one in ranking):
        told.append("Errors count all rows alike; gains count each row by how well it is known.")
    judged_on = {effect_named(one.effect).rows for one in ranking}
    if len(judged_on) > 1 and len({f"{one.held_out_before:.2%}" for one in ranking}) > 1:
        own = [words for rows, words in _OWN_ROWS.items() if rows in judged_on]
        told.append(f"Effects {' and '.join(own)} have errors of their own rows.")
    return " ".join(told)


_OWN_ROWS = {"moving": "near reversals", "breakaway": "at starts from rest"}


def _gain(one: Ranked) -> Gain:
    return Gain(one.gain, one.gain_low, one.gain_high)


def _code(found: Diagnosis) -> ConclusionCode:
    if found.verdict != "nothing":
        return found.verdict
    if found.too_short:
        return "too-short"
    if found.remains:
        return "unexplained"
    if nearest_one(found.candidates) is not None:
        return "likely"
    return "not-confirmed" if found.p_value <= SIGNIFICANT else "nothing"


def _values(found: Diagnosis) -> dict[str, Value]:
    """Names and numbers of the sentence."""
    values: dict[str, Value] = {}
    if found.verdict != "data-problem":
        values["p_value"] = stated(found.p_value)
    if found.driver is not None:
        values["driver"] = found.driver
    best = found.candidates[0] if found.verdict == "missing" else None
    if _code(found) == "likely":
        best = nearest_one(found.candidates)
    if best is not None:
        values |= {
            "effect": best.effect.name,
            "held_out_before": best.before,
            "held_out_after": best.after,
            "gain": best.gain.value,
        }
    return values
