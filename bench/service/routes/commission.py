"""/commission: from a joint of which little is known to a bench.toml, by questions and small motions."""

import math
from dataclasses import asdict
from typing import Literal

from fastapi import Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from bench.commission.bench_file import bench_text, evidence_text
from bench.commission.desk import Asked
from bench.commission.evidence import Finding
from bench.commission.flow import Commissioned
from bench.commission.guide import Guide
from bench.commission.questions import ARM_LENGTH, CommissionError
from bench.commission.steps import STEPS
from bench.runs.bench_control import BenchControl
from bench.service.auth.access import Operator, allow_read
from bench.service.auth.audit_trail import note
from bench.service.http.api_router import api_router
from bench.service.http.downloads import attachment
from bench.service.http.openapi import Document
from bench.service.http.problems import problems
from bench.service.live.status import PromptNow
from bench.service.routes.leases import LeaseOf, require_lease
from bench.service.services import ConductorOf, GuideOf, RunnerOf
from bench.store.errors import NotFoundError

router = api_router("/commission", tags=["commission"], dependencies=[Depends(allow_read)])
BENCH_FILE, EVIDENCE_FILE = "bench.toml", "bench.evidence.json"
FILE = "application/octet-stream"  # to be kept, not shown
QUESTION = {
    "number": 1, "key": ARM_LENGTH.key, "sentence": ARM_LENGTH.sentence, "wants_value": True, "optional": False,
    "unit": ARM_LENGTH.unit, "least": ARM_LENGTH.least, "most": ARM_LENGTH.most,
}  # fmt: skip
FINDING = {
    "name": "resistance_ohm", "value": 0.61, "unit": "ohm", "low": 0.58, "high": 0.64,
    "how": "pushes of the unloaded joint", "experiment_id": 7,
}  # fmt: skip


class StepNow(BaseModel):
    """One step of the way."""

    model_config = ConfigDict(from_attributes=True)
    key: str = Field(examples=["push"])
    title: str = Field(examples=["Pushes"])
    moves: str = Field(description="what moves, and how far; without power, what is done instead")
    low_rad: float = Field(description="where the motor may bring the arm; both 0 where nothing is powered [rad]")
    high_rad: float


class QuestionNow(BaseModel):
    """What the person is asked."""

    number: int = Field(description="send it as `question` with POST /commission/answer", examples=[1])
    key: str = Field(examples=["arm_length_m"])
    sentence: str = Field(examples=["How far from the axis does the load hang?"])
    wants_value: bool = Field(description="false: something is to be done; answer without a value when it is")
    optional: bool = Field(description="whether no value is an answer, too: not known")
    unit: str = Field(description="of the value", examples=["m"])
    least: float | None = Field(description="least value that is allowed")
    most: float | None = Field(description="largest value that is allowed")


class FirstLoad(BaseModel):
    """The weight that was hung as a trial."""

    hung_kg: float
    found_kg: float


class Commission(BaseModel):
    """Where the commissioning is, or how the last one ended."""

    number: int | None = Field(description="of those of this service; null before the first", examples=[1])
    state: Literal["none", "asking", "working", "commissioned", "refused"] = Field(examples=["asking"])
    obstacle: str = Field(description="why the drive of this bench cannot be commissioned; else empty", examples=[""])
    step: str = Field(description="key of the step; empty before the first commissioning", examples=["know"])
    steps: list[StepNow] = Field(description="all of them, in their order", examples=[[asdict(STEPS[3])]])
    question: QuestionNow | None = Field(description="null where nothing is asked", examples=[QUESTION])
    prompt: PromptNow | None = Field(
        description="what the motion waits for; POST /continue answers it", examples=[None]
    )
    evidence: list[Finding] = Field(description="what was found so far, in order", examples=[[FINDING]])
    refusal: str = Field(description="why it did not get through: what was found, and what to do", examples=[""])
    first_load: FirstLoad | None = Field(description="null where none was hung, or not yet", examples=[None])


class Begin(BaseModel):
    """What is commissioned: the drive that the configuration of this bench names."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"travel_deg": 120}]})
    travel_deg: float = Field(
        default=120.0, ge=60, le=360, description="how far the arm may turn to either side of straight down [degrees]"
    )
    name: str = Field(default="", max_length=100, description="of the bench; without it as now")


class Answer(BaseModel):
    """An answer, and to which question."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"question": 1, "value": 0.35}]})
    question: int = Field(ge=1, description="`number` of the question")
    value: float | None = Field(
        default=None, allow_inf_nan=False, description="in the question's unit; null: it is done, or it is not known"
    )


@router.get("", summary="Where the commissioning is")
def state(guide: GuideOf, runner: RunnerOf) -> Commission:
    """Step, what moves and how far, question, evidence so far. Reading this never moves anything."""
    return _represent(guide, runner)


@router.post("", status_code=201, summary="Begin to commission", responses=problems(401, 403, 409, 422))
def begin(
    guide: GuideOf,
    runner: RunnerOf,
    lease: LeaseOf,
    conductor: ConductorOf,
    caller: Operator,
    request: Request,
    body: Begin | None = None,
) -> Commission:
    """Nothing moves before a question of that kind is answered. POST /stop ends it at any time.

    The bench is the caller's until it is over. 409 while an experiment runs, or for a drive in this process.
    """
    wanted = body or Begin()
    if conductor.running is not None:
        raise CommissionError("the queue is running; pause it, or wait for its end")
    with lease.starting(caller.name, engages=True):
        number = guide.begin(wanted.name, math.radians(wanted.travel_deg))
    note(request, f"began commissioning {number}")
    return _represent(guide, runner)


@router.post(
    "/answer",
    summary="Answer a question: after some of them the joint moves",
    dependencies=[Depends(require_lease)],
    responses=problems(401, 403, 409, 422),
)
def answer(guide: GuideOf, runner: RunnerOf, request: Request, body: Answer) -> Commission:
    """409 where that question is not the one that is open now: an answer that comes late moves nothing."""
    key = guide.answer(body.question, body.value)
    note(request, f"answered '{key}' of the commissioning" + ("" if body.value is None else f": {body.value:g}"))
    return _represent(guide, runner)


def _file(name: str) -> dict[int | str, Document]:
    content = {FILE: {"schema": {"type": "string", "format": "binary"}}}
    return {200: {"description": "the file", "content": content, "headers": attachment(name)}, **problems(404)}


@router.get(
    "/bench.toml",
    summary="The bench.toml that was found",
    response_class=Response,
    responses=_file(BENCH_FILE),
)
def bench_file(guide: GuideOf) -> Response:
    """Of the last commissioning that this service saw through; 404 before its end, or where it was refused."""
    return _download(bench_text(_ended(guide).bench, EVIDENCE_FILE), BENCH_FILE)


@router.get(
    "/evidence.json",
    summary="How each value was found",
    response_class=Response,
    responses=_file(EVIDENCE_FILE),
)
def evidence_file(guide: GuideOf) -> Response:
    """Each value with its 95 % interval, from what it was told, and in which experiment; also of one that was refused.

    404 before the first commissioning.
    """
    if guide.course is None:
        raise NotFoundError("nothing was commissioned since this service started; POST /commission begins it")
    return _download(evidence_text(guide.course.evidence), EVIDENCE_FILE)


def _ended(guide: Guide) -> Commissioned:
    if guide.course is None or guide.course.ended is None:
        raise NotFoundError("no commissioning has got through since this service started; GET /commission says why")
    return guide.course.ended


def _download(text: str, name: str) -> Response:
    return Response(text, media_type=FILE, headers={"Content-Disposition": f'attachment; filename="{name}"'})


def _represent(guide: Guide, runner: BenchControl) -> Commission:
    course, prompt = guide.course, runner.status().prompt
    doing, asked = guide.now
    return Commission(
        number=None if course is None else course.number,
        state=doing,
        obstacle=guide.obstacle,
        step="" if course is None else course.step,
        steps=[StepNow.model_validate(one) for one in STEPS],
        question=None if asked is None else _question(asked),
        prompt=PromptNow.model_validate(prompt) if prompt and guide.is_under_way else None,
        evidence=[] if course is None else list(course.evidence),
        refusal="" if course is None else course.refusal,
        first_load=None if course is None or course.ended is None else _first_load(course.ended),
    )


def _question(asked: Asked) -> QuestionNow:
    wanted = asked.question
    return QuestionNow(
        number=asked.number,
        key=asked.key,
        sentence=asked.sentence,
        wants_value=wanted is not None,
        optional=wanted is None or wanted.optional,
        unit="" if wanted is None else wanted.unit,
        least=None if wanted is None else wanted.least,
        most=None if wanted is None else wanted.most,
    )


def _first_load(ended: Commissioned) -> FirstLoad | None:
    return None if math.isnan(ended.first_kg) else FirstLoad(hung_kg=ended.first_kg, found_kg=ended.found_kg)
