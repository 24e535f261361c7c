"""Experiments and trials as they are answered, by the service and by commands: models alone, imported at once."""

from datetime import datetime

from pydantic import BaseModel, Field

from bench.json_types import Json
from bench.store.records import Experiment as StoredExperiment
from bench.store.records import Trial as StoredTrial


class Experiment(BaseModel):
    """What was started, where it came from, and how it ended."""

    experiment_id: int
    kind: str
    parameters: Json
    source: str = Field(description="simulated, real or imported")
    operator: str
    note: str
    tags: list[str]
    provenance: Json = Field(description="software version and commit, configuration, drive, seed")
    rig: Json
    started_utc: datetime
    finished_utc: datetime | None
    outcome: str = Field(description="running, completed, stopped, tripped, failed, interrupted or refused")
    reason: str = Field(description="why it ended")
    results: Json = Field(description="what came out, units in the names")


class Trial(BaseModel):
    """One recording under constant conditions."""

    trial_id: int
    experiment_id: int
    name: str
    kind: str
    conditions: dict[str, float | str | bool] = Field(examples=[{"load_kg": 0.1, "balanced": False, "repeat": 3}])
    outcome: str = Field(description="running, completed, stopped, tripped, failed, interrupted or refused")
    reason: str = Field(description="why it ended")
    results: Json = Field(description="what the procedure found, units in the names")
    channels: list[str] = Field(description="names of the recorded channels, SI with the unit in the name")
    rows: int
    started_utc: datetime
    finished_utc: datetime | None


def experiment_record(found: StoredExperiment) -> Experiment:
    """A stored experiment as it is answered."""
    return Experiment(
        experiment_id=found.id,
        kind=found.kind,
        parameters=found.parameters,
        source=found.source,
        operator=found.operator,
        note=found.note,
        tags=list(found.tags),
        provenance=found.provenance,
        rig=found.rig,
        started_utc=found.started_utc,
        finished_utc=found.finished_utc,
        outcome=found.outcome,
        reason=found.reason,
        results=found.results,
    )


def trial_record(trial: StoredTrial) -> Trial:
    """A stored trial as it is answered."""
    return Trial(
        trial_id=trial.id,
        experiment_id=trial.experiment_id,
        name=trial.name,
        kind=trial.kind,
        conditions=dict(trial.conditions),
        outcome=trial.outcome,
        reason=trial.reason,
        results=trial.results,
        channels=list(trial.channels),
        rows=trial.rows,
        started_utc=trial.started_utc,
        finished_utc=trial.finished_utc,
    )
