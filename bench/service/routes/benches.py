"""/benches: the benches of the laboratory, how the link to it is, and its queue."""

from dataclasses import asdict
from datetime import datetime

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.json_types import Json
from bench.runs.queue.items import known_item
from bench.service.auth.access import Operator, allow_read, require_operator
from bench.service.auth.audit_trail import note
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.http.repeated_start import Key, once
from bench.service.routes.queue_models import Added, ItemId, NewQueueItem, Tags
from bench.service.services import LabLinkOf, StoreOf
from bench.store.tables.benches import SeenBench
from bench.store.tables.lab_queue import NewLabItem

router = api_router(tags=["bench"], dependencies=[Depends(allow_read)])
MOST_ITEMS = 1000


class BenchSeen(BaseModel):
    """A bench, as it last told of itself."""

    name: str = Field(examples=["gear 3"])
    host: str = Field(description="machine that it runs on")
    state: str = Field(description="idle, running; lost where it has not been heard of for 20 s")
    doing: str = Field(description="the experiment that runs")
    lease: str = Field(
        description="who has it, and how long; empty where nobody has", examples=["ada for another 40 s"]
    )
    queue: str = Field(description="how many wait there, and why it is held")
    waiting: int = Field(description="experiments that are recorded and not handed in yet")
    seen_utc: datetime = Field(description="when it was heard of last, by the clock of the database")
    silent_s: float = Field(description="since then")


SEEN = {
    "name": "gear 3",
    "host": "lab-pc-3",
    "state": "running",
    "doing": "steps, 40 %",
    "lease": "ada for another 40 s",
    "queue": "3 waiting",
    "waiting": 0,
    "seen_utc": "2026-01-31T12:00:00Z",
    "silent_s": 1.5,
}


class LabQueueItem(BaseModel):
    """An experiment for whichever bench fits."""

    model_config = ConfigDict(from_attributes=True)
    item_id: int = Field(validation_alias="id")
    kind: str
    parameters: Json
    operator: str
    note: str
    tags: list[str]
    asked_by: str = Field(description="name of the token that asked for it")
    for_bench: str = Field(description="name of the bench that is to take it; empty: any")
    for_rig: str = Field(description="name of the rig that it is for; empty: any")
    for_tags: list[str] = Field(description="what a bench has to have among its lab_tags")
    state: str = Field(description="waiting, taken by a bench that has not begun, or running")
    bench: str = Field(description="that has it; empty where none has")
    silent_s: float | None = Field(description="since that bench last said so; null where none has it")
    declined: dict[str, str] = Field(description="by bench, why it does not take it")
    created_utc: datetime


class NewLabQueueItem(NewQueueItem):
    """An experiment for whichever bench fits, and which those are."""

    for_bench: str = Field(default="", max_length=200, description="name of the bench; empty: any")
    for_rig: str = Field(default="", max_length=200, description="name of the rig; empty: any")
    for_tags: Tags = Field(default=[], description="what the bench has to have among its lab_tags")


class NewLabQueueItems(BaseModel):
    """Experiments for whichever bench fits, taken in all or none."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"examples": [{"items": [{"kind": "steps", "for_tags": ["torque sensor"]}]}]},
    )
    items: list[NewLabQueueItem] = Field(min_length=1, max_length=MOST_ITEMS)


class Laboratory(BaseModel):
    """The benches that share a database."""

    where: str = Field(
        description="the database, without its password; empty where this bench is by itself",
        examples=["postgresql://bench@lab-server/bench"],
    )
    problem: str = Field(
        description="why it is not reached, empty where it is; the bench goes on, and hands in later", examples=[""]
    )
    waiting: int = Field(description="experiments of this bench that are to be handed in", examples=[0])
    benches: list[BenchSeen] = Field(description="this bench alone where there is no laboratory", examples=[[SEEN]])
    queue: list[LabQueueItem] = Field(
        default=[], description="what waits for a bench, is taken or runs, in order; the first 200", examples=[[]]
    )


@router.get("/benches", summary="The benches of the laboratory: state, lease, queue", responses=problems())
def benches(link: LabLinkOf) -> Laboratory:
    """As last heard: nothing is waited for, so it answers also while the laboratory is out of reach."""
    found = link.state
    return Laboratory(
        where=link.where,
        problem=found.problem,
        waiting=found.waiting,
        benches=[_seen(one) for one in found.benches],
        queue=[LabQueueItem.model_validate(one) for one in found.queue],
    )


@router.post(
    "/benches/queue",
    status_code=201,
    summary="Add experiments to the laboratory's queue: a bench that fits takes each, once",
    responses=problems(401, 403, 404, 409, 422, 503),
)
def add(
    link: LabLinkOf, store: StoreOf, request: Request, caller: Operator, body: NewLabQueueItems, key: Key = None
) -> Added:
    """Benches whose owner allows it take them (`store.lab_queue`), each within its own limits. Nothing moves here."""

    def take_in() -> Added:
        items = [known_item(NewLabItem(**one.model_dump(), asked_by=caller.name)) for one in body.items]
        found = link.laboratory().lab_queue.add(items)
        note(request, f"added {len(found)} to the laboratory's queue")
        return Added(item_ids=found)

    asked = {"laboratory": body.model_dump(mode="json")}
    return once(store.access.start_keys, caller.name, key, asked, take_in, Added)


@router.delete(
    "/benches/queue/{item_id}",
    status_code=204,
    summary="Remove an item of the laboratory's queue that no bench has",
    dependencies=[Depends(require_operator)],
    responses=problems(401, 403, 404, 409, 422, 503),
)
def remove(link: LabLinkOf, request: Request, item_id: ItemId) -> None:
    """409 where a bench has it; one whose bench was lost while it ran is given up."""
    link.laboratory().lab_queue.remove(item_id)
    note(request, f"removed item {item_id} of the laboratory's queue")


def _seen(found: SeenBench) -> BenchSeen:
    seen = {"state": found.state, "seen_utc": found.seen_utc, "silent_s": max(0.0, found.silent_s)}
    return BenchSeen(**asdict(found.word) | seen)
