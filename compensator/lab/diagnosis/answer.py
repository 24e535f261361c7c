"""What one family of effects has to say."""

from dataclasses import dataclass

from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.note import Note
from compensator.lab.model.fitted import Fit

EXAMINED = 5  # candidates that are refitted and drawn, of those whose evidence pays for their parameters


@dataclass(frozen=True)
class Answer:
    """What one family of effects has to say.

    Attributes:
        remains: more than noise is left that nothing named here explains.
        Others as in `Diagnosis`.
    """

    verdict: Verdict
    sentence: str
    p_value: float
    candidates: list[Candidate]
    driver: str | None
    notes: list[Note]
    remains: bool = False

    @property
    def explained(self) -> Fit | None:
        """The model with the effect that is named, where it shows in motion."""
        return self.candidates[0].explained if self.verdict == "missing" else None
