"""/studies/N/rounds: what was recorded for a study is picked up, and what it asks for next is queued, in one call."""

from typing import TYPE_CHECKING

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.errors import BusyError
from bench.runs.queue.conductor import Conductor
from bench.service.auth.access import Operator, allow_read
from bench.service.auth.audit_trail import note
from bench.service.compute import at_bench, in_lab
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.http.repeated_start import Key, once
from bench.service.routes.leases import require_lease
from bench.service.routes.studies import StudyId
from bench.service.services import ConductorOf, RunnerOf, StoreOf
from bench.store.tables.queue import RUNNING, WAITING, NewItem
from bench.study.models.study import note_for
from bench.study.suggestion.suggested import NextRound

if TYPE_CHECKING:
    import bench.study.suggestion.next_round
else:
    from bench.service.later import bench

router = api_router("/studies", tags=["studies"], dependencies=[Depends(allow_read)])


class RoundSize(BaseModel):
    """How much is recorded before the study is asked again."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"trials": 2}]})
    trials: int = Field(default=2, ge=1, le=50, description="trials at most")


class Round(NextRound):
    """What was picked up, what it says, and what is recorded next."""

    item_ids: list[int] = Field(description="in the queue; none where no trial is needed, or helps")


@router.post(
    "/{study_id}/rounds",
    status_code=201,
    summary="Pick up what was recorded for a study, diagnose, and queue what it asks for next",
    dependencies=[Depends(require_lease)],
    responses=problems(401, 403, 404, 409, 422),
)
async def begin_round(
    request: Request,
    runner: RunnerOf,
    conductor: ConductorOf,
    store: StoreOf,
    caller: Operator,
    study_id: StudyId,
    body: RoundSize,
    key: Key = None,
) -> Round:
    """Trials that tripped are kept out. 409 while those of the round before wait or run. Takes seconds."""
    await at_bench(request, _refuse_while_recording, conductor, study_id)
    found = await in_lab(
        request, bench.study.suggestion.next_round.next_round, study_id, runner.configuration, body.trials
    )

    def take_in() -> Round:
        _refuse_while_recording(conductor, study_id)
        suggested = found.suggested
        orders = [NewItem(one.kind, one.parameters, note=suggested.note) for one in suggested.trials]
        item_ids = conductor.add(orders, by=caller.name) if orders else []
        note(request, f"queued {len(item_ids)} trials that study {study_id} asks for")
        return Round(extended=found.extended, suggested=suggested, item_ids=item_ids)

    asked = {"study": study_id, **body.model_dump(mode="json")}
    return await at_bench(request, once, store.access.start_keys, caller.name, key, asked, take_in, Round)


def _refuse_while_recording(conductor: Conductor, study_id: int) -> None:
    """Raise while trials that the study asked for are in the queue."""
    left = conductor.table.count_noted(note_for(study_id), WAITING, RUNNING)
    if left:
        raise BusyError(
            f"{left} trials that study {study_id} asked for are in the queue yet; wait for them, or remove them"
        )
