"""What /studies/N/suggest, /studies/N/trials and /studies/N/use answer with."""

from typing import Any

from pydantic import BaseModel, Field


class PairOfRivals(BaseModel):
    """Two effects that may be the missing one; d' from about 6 on tells them apart."""

    true: str = Field(description="taken for the truth")
    rival: str | None = Field(description="null: that nothing is missing")
    before: float | None = Field(description="predicted d' on the trials measured")
    after: float | None = Field(description="with all that are suggested")
    promised: float | None = Field(
        description="reached by nine in ten of the sizes that the trials measured leave it; 0: it may be chance"
    )


class SuggestedTrial(BaseModel):
    """One trial to record, as POST /experiments takes it."""

    name: str = Field(description="kind and parameters in one line")
    kind: str
    parameters: dict[str, Any]
    minutes: float = Field(description="of bench time")
    before: float | None = Field(description="smallest predicted d' of the pairs, with the trials above")
    after: float | None = Field(description="with this one too")
    sentence: str = Field(description="why")


class KeptOut(BaseModel):
    """An experiment that the study asked for and that did not complete: it is not suggested again."""

    experiment_id: int
    kind: str
    outcome: str
    reason: str


class Suggested(BaseModel):
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


class AddedTrial(BaseModel):
    """A trial that a study was given."""

    trial_id: int
    name: str


class Extended(BaseModel):
    """The study with more trials; errors are relative (0..1)."""

    study_id: int
    model_id: int = Field(description="the newest model, fitted to all trials")
    added: list[AddedTrial]
    left_out: list[str] = Field(description="trials too short for the study's filter, or without its effort")
    trials: int
    before: float | None
    after: float | None
    sentence: str


class Used(BaseModel):
    """The calibration that a model was kept as."""

    calibration_id: int
    study_id: int
    model_id: int
    effects: list[str] = Field(description="of the model, those at work")
    left_out: list[str] = Field(description="effects that need more than the motion of the moment")
    sentence: str
