"""Experiments and trials as they are answered, by the service and by commands: models alone, imported at once."""

from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field

from bench.json_types import Json

STORED = ConfigDict(from_attributes=True, populate_by_name=True)  # made from the record of `bench.store` as it is


class Experiment(BaseModel):
    """What was started, where it came from, and how it ended."""

    model_config = STORED
    experiment_id: int = Field(validation_alias="id")
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

    model_config = STORED
    trial_id: int = Field(validation_alias="id")
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
