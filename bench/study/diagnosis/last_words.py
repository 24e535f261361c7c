"""The last words of a report and of a search: what is left, beside what was found, and what the model may hide."""

from collections.abc import Sequence

from bench.study.models.diagnosis import Diagnosis
from compensator.lab.diagnosis.run_to_run import WEIGHT

NONE_CONFIRMED = "No effect of the catalogue is confirmed"
MISSING = "Something is missing, and it is none of the catalogue"
MORE_THAN_NOISE = "is more than noise;"
SMALL = 0.25  # of the first error: a sixteenth of its power


def last_words(found: Diagnosis, added: Sequence[str] = (), share_left: float = 1.0) -> str:
    """What a last model lacks.

    Args:
        found: the diagnosis of it.
        added: names of the effects that were added to the first one, as they are to be shown.
        share_left: its held-out error over that of the first one.
    """
    answer = found.advice if found.slight else _beside(found.sentence, added, share_left)
    beside = [one.text for one in found.findings if one.code == "absorbed" or one.values.get("what") == WEIGHT]
    return " ".join([answer, *(text for text in beside if text not in answer)])


def share_left(first: float, last: float) -> float:
    """Held-out error of the last model over that of the first; 1 where nothing is known."""
    return last / first if first > 0.0 else 1.0


def listed(names: Sequence[str]) -> str:
    """`a, b and c`."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _beside(sentence: str, added: Sequence[str], share_left: float) -> str:
    """An answer that begins with what was found: without that it would be read as if nothing had been."""
    if not added:
        return sentence
    these = f"Beside {listed(added)}"
    if sentence.startswith(MISSING):
        return f"{these} something is missing{sentence.removeprefix('Something is missing')}"
    if not sentence.startswith(NONE_CONFIRMED):
        return sentence
    told = f"{these} no effect of the catalogue is confirmed{sentence.removeprefix(NONE_CONFIRMED)}"
    if share_left > SMALL or MORE_THAN_NOISE not in told:
        return told
    return told.replace(", yet what", "; what", 1).replace(MORE_THAN_NOISE, "is small, but more than noise;", 1)
