"""What one family of effects has to say."""

from dataclasses import dataclass

from compensator.lab.diagnosis.confirmation import LEAST_GAIN_OF_CHAIN
from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.note import Note
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.candidates import Candidates

EXAMINED = 5  # candidates that are refitted and drawn, of those whose evidence pays for their parameters


@dataclass(frozen=True)
class Answer:
    """What one family of effects has to say.

    Attributes:
        remains: more than noise is left that nothing named here explains.
        gathered: what the model may be missing, as the family was judged; None of starts from rest.
        Others as in `Diagnosis`.
    """

    verdict: Verdict
    sentence: str
    p_value: float
    candidates: list[Candidate]
    driver: str | None
    notes: list[Note]
    remains: bool = False
    gathered: Candidates | None = None

    @property
    def explained(self) -> Fit | None:
        """The model with the effect that is named, where it shows in motion."""
        return self.candidates[0].explained if self.verdict == "missing" else None

    @property
    def is_slight(self) -> bool:
        """Whether what is named lowers the error by so little as what every measuring chain bends."""
        return self.verdict == "missing" and self.candidates[0].gain.value < LEAST_GAIN_OF_CHAIN
