"""/queue: experiments one after the other. /campaigns: many of them at once."""

from functools import partial
from typing import Annotated

from fastapi import Depends, Query, Request

from bench.runs.queue.campaign import Campaign, plan_campaign
from bench.runs.queue.overview import MOST_SHOWN, queue_state
from bench.service.auth.access import Operator, allow_read, require_operator
from bench.service.auth.audit_trail import note
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset
from bench.service.http.problems import problems
from bench.service.http.repeated_start import Key, once
from bench.service.routes.leases import require_lease
from bench.service.routes.queue_models import (
    Added,
    ChangedItem,
    Cleared,
    Item,
    ItemId,
    NewQueueItems,
    Plan,
    Queue,
    StartedCampaign,
    plan_of,
)
from bench.service.services import ConductorOf, RunnerOf, StoreOf
from bench.service.stops import StopsOf
from bench.store.tables.queue import NewItem

router = api_router(tags=["queue"], dependencies=[Depends(allow_read)])
HOLDER = [Depends(require_lease)]
taken_in = partial(router.post, status_code=201, dependencies=HOLDER, responses=problems(401, 403, 404, 409, 422))


@router.get("/queue", summary="What waits, what runs, how long it takes", responses=problems(422))
def queue(
    conductor: ConductorOf,
    runner: RunnerOf,
    ended: Annotated[int, Query(ge=0, le=1000, description="how many that came out of the queue")] = 10,
    limit: Limit = MOST_SHOWN,
    offset: Offset = 0,
) -> Queue:
    """Reading this never moves anything. What waits comes in pages of `limit`; all else is of the whole queue."""
    return Queue.model_validate(queue_state(conductor, runner, ended, limit, offset))


@taken_in("/queue", summary="Add experiments: they start when it is their turn, at once where nothing is before them")
def add(
    conductor: ConductorOf, store: StoreOf, request: Request, caller: Operator, body: NewQueueItems, key: Key = None
) -> Added:
    """All or none: one that would be refused refuses the request. While the queue is held they wait."""

    def take_in() -> Added:
        orders = [NewItem(**one.model_dump()) for one in body.items]
        found = conductor.add(orders, by=caller.name)
        note(request, f"added {len(found)} to the queue")
        return Added(item_ids=found)

    asked = {"queue": body.model_dump(mode="json")}
    return once(store.access.start_keys, caller.name, key, asked, take_in, Added)


@router.get("/queue/{item_id}", summary="One item", responses=problems(404))
def item(conductor: ConductorOf, item_id: ItemId) -> Item:
    """Also one that has come out of the queue."""
    return Item.model_validate(conductor.table.item(item_id))


@router.patch(
    "/queue/{item_id}",
    summary="Move an item, or change what is noted with it",
    dependencies=[*HOLDER, Depends(require_operator)],
    responses=problems(401, 403, 404, 409, 422),
)
def change(conductor: ConductorOf, request: Request, item_id: ItemId, body: ChangedItem) -> Item:
    """409 where it does not wait any more."""
    values = body.model_dump(exclude_none=True)
    position = values.pop("position", None)
    if values:
        conductor.table.change(item_id, values)
    if position is not None:
        conductor.table.move(item_id, position)
    note(request, f"changed item {item_id} of the queue")
    return Item.model_validate(conductor.table.item(item_id))


@router.delete(
    "/queue/{item_id}",
    status_code=204,
    summary="Remove an item that waits",
    dependencies=[*HOLDER, Depends(require_operator)],
    responses=problems(401, 403, 404, 409),
)
def remove(conductor: ConductorOf, request: Request, item_id: ItemId) -> None:
    """409 where it does not wait any more; what runs is ended with POST /stop."""
    conductor.table.remove(item_id)
    note(request, f"removed item {item_id} of the queue")


@router.delete(
    "/queue",
    summary="Remove all that waits",
    dependencies=[*HOLDER, Depends(require_operator)],
    responses=problems(401, 403, 409),
)
def clear(conductor: ConductorOf, request: Request) -> Cleared:
    """What runs goes on; it is ended with POST /stop."""
    removed = conductor.table.clear()
    note(request, f"removed {removed} of the queue")
    return Cleared(removed=removed)


@router.post(
    "/queue/pause",
    summary="Stand still after the trial that runs, and start nothing more",
    responses=problems(401, 403),
)
def pause(conductor: ConductorOf, runner: RunnerOf, request: Request, caller: Operator) -> Queue:
    """The power is off meanwhile. Whoever has the bench: standing still is no harm."""
    conductor.pause(f"paused by {caller.name}")
    note(request, "paused the queue")
    return Queue.model_validate(queue_state(conductor, runner))


@router.post(
    "/queue/resume",
    summary="Go on: the joint moves",
    dependencies=HOLDER,
    responses=problems(401, 403, 409),
)
def resume(conductor: ConductorOf, runner: RunnerOf, request: Request, caller: Operator, stops: StopsOf) -> Queue:
    """After a pause, after a stop or a failure, and after a start of the service. Look at the bench first."""
    with stops.starting():
        conductor.resume(caller.name)
    note(request, "resumed the queue")
    return Queue.model_validate(queue_state(conductor, runner))


@router.post(
    "/campaigns/plan",
    summary="What a campaign comes to: order, duration, load changes",
    dependencies=[Depends(require_operator)],
    responses=problems(401, 403, 404, 422),
)
def plan(runner: RunnerOf, body: Campaign) -> Plan:
    """Checks every experiment, and changes nothing."""
    return plan_of(body.name, plan_campaign(body, runner.configuration))


@taken_in("/campaigns", summary="Put a campaign into the queue")
def start(
    conductor: ConductorOf,
    runner: RunnerOf,
    store: StoreOf,
    request: Request,
    caller: Operator,
    body: Campaign,
    key: Key = None,
) -> StartedCampaign:
    """All of its experiments, or none where one would be refused."""
    kept = body.model_dump(mode="json")

    def take_in() -> StartedCampaign:
        found = plan_campaign(body, runner.configuration)
        common = {name: kept[name] for name in ("name", "operator", "note", "tags")}
        item_ids = conductor.add_items(found.items, {**common, "definition": kept}, by=caller.name)
        note(request, f"started campaign '{body.name}': {len(item_ids)} experiments")
        return StartedCampaign(item_ids=item_ids, **dict(plan_of(body.name, found)))

    return once(store.access.start_keys, caller.name, key, {"campaign": kept}, take_in, StartedCampaign)
