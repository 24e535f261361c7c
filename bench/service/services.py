"""What the routes lean on: the store and the runner of this application, as FastAPI dependencies."""

from typing import Annotated, cast

from fastapi import Depends, Request

from bench.commission.guide import Guide
from bench.runs.bench_control import BenchControl
from bench.runs.calibrator import Calibrator
from bench.runs.lab_link import LabLink
from bench.runs.queue.conductor import Conductor
from bench.store import Store


async def _store(request: Request) -> Store:
    return cast(Store, request.app.state.store)


async def _runner(request: Request) -> BenchControl:
    return cast(BenchControl, request.app.state.runner)


async def _conductor(request: Request) -> Conductor:
    return cast(Conductor, request.app.state.conductor)


async def _calibrator(request: Request) -> Calibrator:
    return cast(Calibrator, request.app.state.calibrator)


async def _lab_link(request: Request) -> LabLink:
    return cast(LabLink, request.app.state.lab_link)


async def _guide(request: Request) -> Guide:
    return cast(Guide, request.app.state.guide)


StoreOf = Annotated[Store, Depends(_store)]
RunnerOf = Annotated[BenchControl, Depends(_runner)]
ConductorOf = Annotated[Conductor, Depends(_conductor)]
CalibratorOf = Annotated[Calibrator, Depends(_calibrator)]
LabLinkOf = Annotated[LabLink, Depends(_lab_link)]
GuideOf = Annotated[Guide, Depends(_guide)]
