"""What the store returns: frozen records, one per row. Times are UTC with time zone."""

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from bench.json_types import Values
from compensator.lab.recordings.recording import Condition as Condition
from compensator.lab.recordings.recording import Event as Event

OUTCOMES = ("running", "completed", "stopped", "tripped", "failed", "interrupted", "refused")
IMPORTING, REMOVING = "importing", "removing"
HIDDEN = (IMPORTING, REMOVING)  # outcomes of what is not there yet, or not any more: nobody sees it
SOURCES = ("simulated", "real", "imported")


@dataclass(frozen=True, slots=True)
class NewExperiment:
    """An experiment that begins, or that comes in from elsewhere.

    Attributes:
        source: "simulated", "real" or "imported".
        others: as in `Experiment`.
    """

    kind: str
    parameters: Values
    provenance: Values
    rig: Values
    source: str
    operator: str = ""
    note: str = ""


@dataclass(frozen=True, slots=True)
class Experiment:
    """What a user started: a kind, its parameters, and where it came from.

    Attributes:
        source: one of `SOURCES`.
        outcome: one of `OUTCOMES`; `reason` says why.
        rig: the rig as in `rig.toml`.
        results: JSON-able, units in the names; empty while it runs.
        tags: free words that it is found by.
    """

    id: int
    kind: str
    parameters: dict[str, Any]
    source: str
    operator: str
    note: str
    provenance: dict[str, Any]
    rig: dict[str, Any]
    started_utc: datetime
    finished_utc: datetime | None
    outcome: str
    reason: str
    results: dict[str, Any]
    tags: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Trial:
    """One recording under constant conditions.

    Attributes:
        conditions: what was held constant; the keys carry units.
        channels: names of the recorded channels (`bench.config.channels`).
        outcome: one of `OUTCOMES`; `reason` says why.
    """

    id: int
    experiment_id: int
    name: str
    kind: str
    conditions: dict[str, Condition]
    channels: tuple[str, ...]
    rows: int
    started_utc: datetime
    finished_utc: datetime | None
    outcome: str
    reason: str
    results: dict[str, Any]


@dataclass(frozen=True, slots=True)
class StudyRow:
    """A study: which trials, and how they are split."""

    id: int
    name: str
    definition: dict[str, Any]
    created_utc: datetime


@dataclass(frozen=True, slots=True)
class ModelRow:
    """One model of a study: its effects, what came out, and the model it was made from."""

    id: int
    study_id: int
    parent_id: int | None
    effects: list[str]
    result: dict[str, Any]
    created_utc: datetime


@dataclass(frozen=True, slots=True)
class CalibrationRow:
    """Friction curves of one rig, and where they come from.

    Attributes:
        source: that of the experiments, one of `SOURCES`.
        rig, drive: that they hold for; the drive is {} where it is not known.
        provenance: of the software that fitted them.
        result: see `bench.calibration.calibrate`.
        chosen_utc: when it was last named as the one to use; None: never, or taken back.
    """

    id: int
    note: str
    source: str
    rig: dict[str, Any]
    drive: dict[str, Any]
    provenance: dict[str, Any]
    experiment_ids: list[int]
    trial_ids: list[int]
    result: dict[str, Any]
    created_utc: datetime
    chosen_utc: datetime | None
