"""/benches: the benches of the laboratory, and how the link to it is."""

from datetime import datetime

from fastapi import APIRouter, Depends
from pydantic import BaseModel, Field

from bench.service.auth.access import allow_read
from bench.service.http.problems import problems
from bench.service.services import LabLinkOf
from bench.store.tables.benches import SeenBench

router = APIRouter(tags=["bench"], dependencies=[Depends(allow_read)])


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


@router.get("/benches", summary="The benches of the laboratory: state, lease, queue", responses=problems())
def benches(link: LabLinkOf) -> Laboratory:
    """As last heard: nothing is waited for, so it answers also while the laboratory is out of reach."""
    found = link.state
    return Laboratory(
        where=link.where,
        problem=found.problem,
        waiting=found.waiting,
        benches=[_seen(one) for one in found.benches],
    )


def _seen(found: SeenBench) -> BenchSeen:
    word = found.word
    return BenchSeen(
        name=word.name,
        host=word.host,
        state=found.state,
        doing=word.doing,
        lease=word.lease,
        queue=word.queue,
        waiting=word.waiting,
        seen_utc=found.seen_utc,
        silent_s=max(0.0, found.silent_s),
    )
