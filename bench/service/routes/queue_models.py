"""What the routes of the queue take and answer; what starts an experiment at once is nearly the same."""

from datetime import datetime
from typing import Annotated, Literal

from fastapi import Path
from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError

from bench.config.validation import problems
from bench.experiments.registry import find_kind
from bench.json_types import Json
from bench.runs.queue.campaign import MOST_ITEMS, CampaignPlan
from bench.service.http.problems import InvalidFieldsError, field_problems
from bench.store.tables.queue import NewItem
from bench.store.tables.tags import LONGEST_TAG, MOST_TAGS

ItemId = Annotated[int, Path(ge=1, le=2**31 - 1, description="number of the item")]
Tag = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=LONGEST_TAG)]
Tags = Annotated[list[Tag], Field(max_length=MOST_TAGS, description="free words to find experiments by")]
Note = Annotated[str, Field(max_length=2000)]
Operator = Annotated[str, Field(max_length=200)]


class NewQueueItem(BaseModel):
    """An experiment to come."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "examples": [{"kind": "steps", "parameters": {"repeats": 3, "load_kg": 0.1}, "tags": ["winter"]}]
        },
    )
    kind: str = Field(max_length=100, description="name from GET /experiment-kinds")
    parameters: Json = Field(default={}, description="what differs from the defaults, SI")
    operator: Operator = ""
    note: Note = ""
    tags: Tags = []
    pace: Literal["real-time", "fast"] | None = Field(default=None, description="as for POST /experiments")


class NewExperiment(NewQueueItem):
    """What to start."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"kind": "steps", "parameters": {"repeats": 3, "load_kg": 0.1}, "operator": "R. Saini"}]
        },
    )
    pace: Literal["real-time", "fast"] | None = Field(
        default=None, description="fast: as fast as the computer can, simulated drive only, and the default there"
    )

    def refuse_mistyped(self) -> None:
        """Refuse parameters that the kind's model does not take, before anything is recorded.

        Raises:
            UnknownKindError: no such kind.
            InvalidFieldsError: with each field, its value and what is allowed.
        """
        kind = find_kind(self.kind)
        try:
            kind.parameters.model_validate(self.parameters)
        except ValidationError as error:
            fields = field_problems(error, prefix="parameters", model=kind.parameters)
            words = "; ".join(problems(error, model=kind.parameters))
            raise InvalidFieldsError(f"{self.kind}: {words}", "ParameterError", fields) from error


class NewQueueItems(BaseModel):
    """Experiments to come, taken in all or none."""

    model_config = ConfigDict(extra="forbid")
    items: list[NewQueueItem] = Field(min_length=1, max_length=MOST_ITEMS)


class ChangedItem(BaseModel):
    """What is changed of an item that waits; what is left out stays."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"position": 0}]})
    position: int | None = Field(default=None, ge=0, description="its new place among those that wait, from 0")
    operator: Operator | None = None
    note: Note | None = None
    tags: Tags | None = None


class Item(BaseModel):
    """An experiment in the queue, or one that came out of it."""

    model_config = ConfigDict(from_attributes=True)
    item_id: int = Field(validation_alias="id")
    campaign_id: int | None
    kind: str
    parameters: Json
    operator: str
    note: str
    tags: list[str]
    duration_s: float = Field(description="estimate, in the joint's time")
    state: str = Field(description="waiting, running, or how its experiment ended")
    reason: str = Field(description="why it ended")
    experiment_id: int | None
    created_utc: datetime
    finished_utc: datetime | None


class Queue(BaseModel):
    """The queue of the bench."""

    model_config = ConfigDict(from_attributes=True)
    state: Literal["idle", "running", "pausing", "paused", "held"] = Field(
        description="held: nothing is started until somebody resumes; pausing: it stands still after its present trial"
    )
    reason: str = Field(description="why it is held or paused, or that another process runs an item")
    running: Item | None
    waiting: list[Item] = Field(description="a page of those that wait, in the order in which they will be run")
    waiting_count: int = Field(description="how many wait in all")
    next_offset: int | None = Field(default=None, description="offset of the next page; null on the last")
    duration_s: float = Field(description="estimate of all of them, in the joint's time; a simulated one may be faster")
    left_s: float = Field(description="what is left of it")
    load_changes: int = Field(description="how often something has to be hung yet")
    ended: list[Item] = Field(description="what came out last, newest first")


class Added(BaseModel):
    """The items that were taken in."""

    item_ids: list[int]


class Cleared(BaseModel):
    """How many items were removed."""

    removed: int


class PlannedItem(BaseModel):
    """One experiment of a campaign."""

    kind: str
    parameters: Json
    loads_kg: list[float] = Field(description="that are hung in turn")
    duration_s: float


class Plan(BaseModel):
    """What a campaign comes to, in the order in which it is run."""

    name: str
    items: list[PlannedItem]
    duration_s: float = Field(description="estimate of the whole, in the joint's time, hanging of loads included")
    load_changes: int = Field(description="how often something has to be hung, the first load included")


class StartedCampaign(Plan):
    """A campaign in the queue."""

    item_ids: list[int]


def plan_of(name: str, found: CampaignPlan) -> Plan:
    """The plan of a campaign as it is answered."""
    items = [_planned(one) for one in found.items]
    return Plan(name=name, items=items, duration_s=found.duration_s, load_changes=found.load_changes)


def _planned(item: NewItem) -> PlannedItem:
    loads_kg = [float(load) for load, _ in item.loads]
    return PlannedItem(kind=item.kind, parameters=item.parameters, loads_kg=loads_kg, duration_s=item.duration_s)
