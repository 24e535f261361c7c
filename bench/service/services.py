"""What the routes lean on: what the application keeps, as FastAPI dependencies."""

from typing import Annotated, Any

from fastapi import Depends, Request

from bench.commission.guide import Guide
from bench.runs.bench_control import BenchControl
from bench.runs.calibrator import Calibrator
from bench.runs.lab_link import LabLink
from bench.runs.queue.conductor import Conductor
from bench.store import Store


def _kept(name: str) -> Any:
    """A dependency that finds what the application keeps under a name. Async: a plain one would wait for a thread."""

    async def found(request: Request) -> Any:
        return getattr(request.app.state, name)

    return Depends(found)


StoreOf = Annotated[Store, _kept("store")]
RunnerOf = Annotated[BenchControl, _kept("runner")]
ConductorOf = Annotated[Conductor, _kept("conductor")]
CalibratorOf = Annotated[Calibrator, _kept("calibrator")]
LabLinkOf = Annotated[LabLink, _kept("lab_link")]
GuideOf = Annotated[Guide, _kept("guide")]
