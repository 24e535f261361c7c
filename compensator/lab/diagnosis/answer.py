"""What one family of effects has to say."""

from dataclasses import dataclass

from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.note import Note
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.evidence import Evidence

EXAMINED = 6  # candidates that are refitted and drawn, of those whose evidence pays for their parameters


@dataclass(frozen=True)
class Answer:
    """What one family of effects has to say.

    Attributes:
        strength: noncentrality of what decided: the best effect, or the free curve that no effect follows.
        gain: relative fall of the held-out error by that.
        remains: more than noise is left that nothing named here explains.
        explained: the model with the effect that is named, where one of the joint or the chain is.
        named: evidence for that effect.
        Others as in `Diagnosis`.
    """

    verdict: Verdict
    sentence: str
    p_value: float
    candidates: list[Candidate]
    driver: str | None
    notes: list[Note]
    strength: float = 0.0
    gain: float = 0.0
    remains: bool = False
    explained: Fit | None = None
    named: Evidence | None = None
