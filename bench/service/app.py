"""The application: routes, errors, guard, page."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version

from fastapi import APIRouter, FastAPI

from bench.runner import Runner
from bench.service import (
    bench_state,
    calibrations,
    effects,
    error_map,
    experiments,
    live,
    page,
    problems,
    recording_sets,
    studies,
    trials,
)
from bench.service.access import Access
from bench.service.guard import Guard
from bench.store import Store

PREFIX = "/api/v1"
DESCRIPTION = """
Test bench for one geared servo joint: run experiments, watch and stop them, read trials, and find the physical
effect that a model is missing.

* **Units** are SI and stand in every name: `load_kg`, `speed_rad_s`, `current_a`. Not measured is `null`, never 0.
* **Reading** is open on loopback. **Changing** anything (POST, DELETE) needs the token that `friction-bench serve`
  printed, as `Authorization: Bearer <token>`. Nothing that is read with GET ever moves the joint.
* **Stop**: `POST /api/v1/stop`, always, by any holder of the token.
* **Errors** are problem+json: `detail` is a sentence with value, limit and unit; `errors` the same, field by field.

A run, watched and read:

    POST /api/v1/experiments        {"kind": "steps", "parameters": {"repeats": 3, "load_kg": 0.1}}
    GET  /api/v1/live               server-sent events: status and rows as they are recorded
    GET  /api/v1/trials?experiment_id=1
    GET  /api/v1/trials/1/csv

Friction curves, calibrated and used:

    POST /api/v1/experiments        {"kind": "speed-sweep"}
    POST /api/v1/experiments        {"kind": "load-sweep", "parameters": {"angles_rad": [0]}}
    POST /api/v1/calibrations       {"experiment_ids": [1, 2]}
    GET  /api/v1/calibrations/1/picture

A missing effect, found and added:

    POST /api/v1/studies            {"name": "arm", "experiment_ids": [1], "hold_out": ["load_kg=0.1"]}
    GET  /api/v1/studies/1/compare
    GET  /api/v1/studies/1/diagnose
    POST /api/v1/studies/1/models   {"effect": "viscous_asymmetry"}
    GET  /api/v1/studies/1/ladder
"""


def create_app(store: Store, runner: Runner, access: Access) -> FastAPI:
    """The service.

    Args:
        store: where trials and studies are kept; stays the caller's to close.
        runner: runs the experiments; closed (joint stopped, power off) when the application ends.
        access: token, hosts, and whether reading is open.
    """

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        yield
        runner.close()

    app = FastAPI(
        title="friction-bench",
        version=version("friction-bench"),
        summary="Bench driver and test service for a geared servo joint",
        description=DESCRIPTION,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # their pages load scripts from elsewhere
        redoc_url=None,
        lifespan=lifespan,
        license_info={"name": "Apache-2.0", "identifier": "Apache-2.0"},
    )
    app.state.store, app.state.runner, app.state.access, app.state.ending = store, runner, access, False
    problems.install(app)
    api = APIRouter(prefix=PREFIX)
    for module in (bench_state, experiments, live, trials, recording_sets, calibrations, studies, error_map, effects):
        api.include_router(module.router)
    app.include_router(api)
    page.install(app)
    app.add_middleware(Guard, hosts=access.hosts)
    return app
