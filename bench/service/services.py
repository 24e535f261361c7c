"""What the routes lean on: the store and the runner of this application, as FastAPI dependencies."""

from typing import Annotated, cast

from fastapi import Depends, Request

from bench.queue import Conductor
from bench.runner import Runner
from bench.store import Store


async def _store(request: Request) -> Store:
    return cast(Store, request.app.state.store)


async def _runner(request: Request) -> Runner:
    return cast(Runner, request.app.state.runner)


async def _conductor(request: Request) -> Conductor:
    return cast(Conductor, request.app.state.conductor)


StoreOf = Annotated[Store, Depends(_store)]
RunnerOf = Annotated[Runner, Depends(_runner)]
ConductorOf = Annotated[Conductor, Depends(_conductor)]
