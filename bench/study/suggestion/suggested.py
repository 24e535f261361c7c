"""What is suggested to be recorded next, and why."""

from pydantic import Field

from bench.json_types import Json, Number
from bench.study.models.base import StudyModel
from bench.study.models.study import Extended


class PairOfRivals(StudyModel):
    """Two effects that may be the missing one; d' from about 6 on tells them apart."""

    true: str = Field(description="taken for the truth")
    rival: str | None = Field(description="null: that nothing is missing")
    before: Number = Field(description="predicted d' on the trials measured")
    after: Number = Field(description="with all that are suggested")
    promised: Number = Field(
        description="reached by nine in ten of the sizes that the trials measured leave it; 0: it may be chance"
    )


class SuggestedTrial(StudyModel):
    """One trial to record, as POST /experiments takes it."""

    name: str = Field(description="kind and parameters in one line")
    kind: str
    parameters: Json
    minutes: float = Field(description="of bench time")
    before: Number = Field(description="smallest predicted d' of the pairs, with the trials above")
    after: Number = Field(description="with this one too")
    sentence: str = Field(description="why")


class KeptOut(StudyModel):
    """An experiment that the study asked for and that did not complete: it is not suggested again."""

    experiment_id: int
    kind: str
    outcome: str
    reason: str


class Suggested(StudyModel):
    """Trials to record next, in order."""

    study_id: int
    model_id: int
    verdict: str
    diagnosis: str
    sentence: str
    minutes: float
    note: str = Field(description="to be given to the experiments: by it the study finds their trials")
    pairs: list[PairOfRivals]
    hopeless: list[PairOfRivals] = Field(description="pairs that no trial of this bench tells apart")
    kept_out: list[KeptOut] = Field(description="tripped or failed when they were run; others take their place")
    trials: list[SuggestedTrial]


class Came(StudyModel):
    """Smallest d' of a rival: predicted with the trials of a round, and what the next round begins with."""

    effect: str
    before: Number = Field(description="what that round began with")
    predicted: Number
    came: float | None = Field(description="null: it is no rival any more")


class NextRound(StudyModel):
    """What was picked up since the last round, and what is to be recorded next."""

    extended: Extended | None = Field(description="null: nothing was recorded for the study since the last round")
    suggested: Suggested
