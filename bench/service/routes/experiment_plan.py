"""/experiments/plan: what a start would move, how far and for how long; nothing moves and nothing is recorded."""

from fastapi import Depends
from pydantic import BaseModel, Field

from bench.config.configuration import BenchConfiguration
from bench.experiments.kind import TrialPlan
from bench.experiments.registry import find_kind, parse_parameters
from bench.service.auth.access import require_viewer
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.routes.queue_models import NewExperiment
from bench.service.routes.refused_fields import told_at_its_fields
from bench.service.services import RunnerOf

router = api_router(tags=["experiments"], dependencies=[Depends(require_viewer)])


class PlannedStart(BaseModel):
    """What a start would do."""

    kind: str
    trials: int
    duration_s: float = Field(description="estimate, in the joint's time; a simulated one may be faster")
    angles_rad: list[float] = Field(description="lowest and highest angle that a trial names; empty: none is named")
    position_limits_rad: list[float] = Field(
        min_length=2, max_length=2, description="lowest and highest of the bench; the joint never leaves them"
    )
    speed_rad_s: float | None = Field(description="highest speed that a trial names; null: none is named")
    loads_kg: list[float] = Field(description="loads that are hung on the arm, lightest first")
    balanced: bool = Field(description="whether a balanced arm is needed")


@router.post("/experiments/plan", summary="What a start would move", responses=problems(401, 404, 422))
def plan(runner: RunnerOf, body: NewExperiment) -> PlannedStart:
    """The checks of a start that need no drive: 422 names each field with its value, limit and unit."""
    body.refuse_mistyped()
    kind = find_kind(body.kind)
    parameters = parse_parameters(kind, body.parameters)
    with told_at_its_fields(kind):
        kind.refuse(parameters, runner.configuration)
    plans = kind.plan(parameters, runner.configuration)
    return _motion(body.kind, plans, kind.duration_s(parameters, runner.configuration), runner.configuration)


def _motion(kind: str, plans: list[TrialPlan], duration_s: float, configuration: BenchConfiguration) -> PlannedStart:
    named = [(key, value) for plan in plans for key, value in plan.conditions.items() if isinstance(value, float)]
    angles = [value for key, value in named if key == "angle_rad"]
    speeds = [abs(value) for key, value in named if key.endswith("speed_rad_s") or key == "approach_rad_s"]
    limits = configuration.limits
    return PlannedStart(
        kind=kind,
        trials=len(plans),
        duration_s=duration_s,
        angles_rad=[min(angles), max(angles)] if angles else [],
        position_limits_rad=[limits.position_min_rad, limits.position_max_rad],
        speed_rad_s=max(speeds, default=None),
        loads_kg=sorted({plan.load_kg for plan in plans}),
        balanced=any(plan.balanced for plan in plans),
    )
