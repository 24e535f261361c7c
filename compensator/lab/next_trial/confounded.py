"""Which effects of a diagnosis are to be told apart by what is recorded next."""

from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis

MOST_RIVALS = 4
RUNNERS_UP = 3  # that are looked at where no class of several is named


def rivals_of(diagnosis: Diagnosis) -> list[Candidate]:
    """The class that is named; where it has one member, or nothing is named, the next in rank too. One family alone.

    Where nothing is sure, starts from rest may speak for an effect while motion speaks for none: they need trials of
    their own, so that then these are the rivals.
    """
    named = diagnosis.named
    first = diagnosis.candidates[:1]
    if first and not named:
        from_rest = [one for one in diagnosis.candidates if one.rows == "breakaway" and _speaks_for_itself(one)]
        first = sorted([*first, *from_rest], key=lambda one: -one.score)[:1]
    family = [one for one in diagnosis.candidates if _of_one_kind(one, first[0])] if first else []
    members = [one for one in family if one.effect.name in named]
    return members[:MOST_RIVALS] if len(members) > 1 else family[:RUNNERS_UP]


def _speaks_for_itself(candidate: Candidate) -> bool:
    """Whether a candidate that is not sure pays for its parameters, can be it, and would lower the held-out error."""
    return candidate.score > 0.0 and candidate.physical and candidate.gain.value > 0.0


def several(diagnosis: Diagnosis) -> bool:
    """Whether a class of several effects is named."""
    return len(diagnosis.named) > 1


def shows_from_rest(diagnosis: Diagnosis) -> bool:
    """Whether the rivals of a diagnosis are told apart by starts from rest."""
    return any(one.rows == "breakaway" for one in rivals_of(diagnosis)[:1])


def _of_one_kind(candidate: Candidate, first: Candidate) -> bool:
    return (candidate.rows, candidate.effect.pipeline) == (first.rows, first.effect.pipeline)
