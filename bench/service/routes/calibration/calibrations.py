"""/calibrations: friction curves from recorded sweeps, their points, and which of them the bench uses."""

from datetime import datetime
from typing import Annotated

from fastapi import Depends, Path, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from bench import calibration
from bench.calibration.curve_data import Picture, curve_data
from bench.calibration.curves import Curve
from bench.json_types import Json
from bench.service.auth.access import allow_read, require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_worker
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.services import RunnerOf, StoreOf
from bench.store import CalibrationRow
from bench.store.errors import NotFoundError

router = api_router("/calibrations", tags=["calibrations"], dependencies=[Depends(allow_read)])
CalibrationId = Annotated[int, Path(ge=1, description="number of the calibration")]


class NewCalibration(BaseModel):
    """What to calibrate from."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"experiment_ids": [1, 2]}]})
    experiment_ids: list[Annotated[int, Field(ge=1)]] = Field(
        min_length=1,
        max_length=100,
        description="speed sweeps, or imported trials of the balanced joint; load sweeps for the F_load of each load",
    )
    stribeck: bool = Field(default=True, description="false: Coulomb and viscous friction alone")
    note: str = Field(default="", max_length=2000)


class Calibration(BaseModel):
    """Friction curves of one rig, and where they come from."""

    calibration_id: int
    note: str
    source: str
    rig: Json
    drive: Json = Field(description="that it was measured on; {} where it is not known")
    provenance: Json
    experiment_ids: list[int]
    trial_ids: list[int]
    stribeck: bool
    curves: list[Curve]
    motor: Json = Field(description="R and Ke with intervals as far as the sweep tells; why, where not")
    at_rest: str = Field(
        description="what its searches at rest did not tell, or told of one side alone; '' where nothing is missing"
    )
    in_use: bool = Field(description="whether this bench compensates with it")
    created_utc: datetime
    chosen_utc: datetime | None


class Calibrations(Page):
    """One page of calibrations, newest first."""

    items: list[Calibration]


def represent(row: CalibrationRow, used_id: int | None) -> Calibration:
    """A stored calibration as it is answered."""
    return Calibration(
        calibration_id=row.id,
        note=row.note,
        source=row.source,
        rig=row.rig,
        drive=row.drive,
        provenance=row.provenance,
        experiment_ids=list(row.experiment_ids),
        trial_ids=list(row.trial_ids),
        stribeck=row.result["stribeck"],
        curves=row.result["curves"],
        motor=row.result["motor"],
        at_rest=row.result.get("rest_unidentified") or row.result.get("rest_one_sided") or "",
        in_use=row.id == used_id,
        created_utc=row.created_utc,
        chosen_utc=row.chosen_utc,
    )


@router.post(
    "",
    status_code=201,
    summary="Fit and keep a calibration",
    dependencies=[Depends(require_token)],
    responses=problems(401, 403, 404, 422),
)
async def create(
    request: Request, response: Response, store: StoreOf, runner: RunnerOf, body: NewCalibration
) -> Calibration:
    """From experiments that were run or imported; nothing moves. Takes a second or so."""

    def made() -> Calibration:
        number = calibration.calibrate(store, body.experiment_ids, body.stribeck, body.note)
        note(request, f"made calibration {number} from experiments {', '.join(map(str, body.experiment_ids))}")
        return represent(store.calibrations.get(number), _used_id(store, runner))

    found = await in_worker(request, made)
    response.headers["Location"] = f"{request.url.path}/{found.calibration_id}"
    return found


@router.get("", summary="What was calibrated", responses=problems(422))
def calibrations(
    store: StoreOf,
    runner: RunnerOf,
    limit: Limit = 100,
    offset: Offset = 0,
) -> Calibrations:
    """Newest first."""
    found, used_id = store.calibrations.find(limit + 1, offset), _used_id(store, runner)
    items, page = cut(found, limit, offset)
    return Calibrations(items=[represent(one, used_id) for one in items], **page)


@router.get("/in-use", summary="The calibration that this bench uses", responses=problems(404))
def in_use(store: StoreOf, runner: RunnerOf) -> Calibration:
    """The one that was chosen, else the newest that fits rig and drive."""
    found = calibration.in_use(store, runner.configuration)
    if found is None:
        raise NotFoundError("no calibration fits this bench; run a speed sweep, and calibrate from it")
    return represent(found, found.id)


@router.delete(
    "/in-use", summary="Use the newest that fits, from now on", dependencies=[Depends(require_token)],
    responses=problems(401, 403, 404),
)  # fmt: skip
def use_latest(store: StoreOf, runner: RunnerOf) -> Calibration:
    """Takes back what was chosen."""
    calibration.use(store, runner.configuration, None)
    return in_use(store, runner)


@router.get("/{calibration_id}", summary="One calibration", responses=problems(404))
def one(store: StoreOf, runner: RunnerOf, calibration_id: CalibrationId) -> Calibration:
    """Curves with intervals, motor constants, experiments and trials behind them."""
    return represent(store.calibrations.get(calibration_id), _used_id(store, runner))


@router.get("/{calibration_id}/picture", summary="Its points and curves, to be drawn", responses=problems(404))
def picture(store: StoreOf, calibration_id: CalibrationId) -> Picture:
    """Speed against current (Fig. 2), friction part of the duty against speed (Fig. 3)."""
    return curve_data(store.calibrations.get(calibration_id))


@router.post(
    "/{calibration_id}/use",
    summary="Compensate with this one from now on",
    dependencies=[Depends(require_token)],
    responses=problems(401, 403, 404, 422),
)
def use(store: StoreOf, runner: RunnerOf, calibration_id: CalibrationId) -> Calibration:
    """422 where it is of another rig. An experiment that runs keeps what it began with."""
    calibration.use(store, runner.configuration, calibration_id)
    return represent(store.calibrations.get(calibration_id), _used_id(store, runner))


def _used_id(store: StoreOf, runner: RunnerOf) -> int | None:
    found = calibration.in_use(store, runner.configuration)
    return None if found is None else found.id
