"""The application: routes, errors, guard, page."""

import asyncio
import secrets
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import partial

import anyio.to_thread
from fastapi import FastAPI

from bench import __version__
from bench.commission.guide import ENDED, Guide
from bench.runs.bench_control import BenchControl
from bench.runs.calibrator import Calibrator
from bench.runs.lab_link import LabLink, word_of
from bench.runs.lab_work import LabWork
from bench.runs.lease import Lease
from bench.runs.queue.conductor import Conductor
from bench.service import compute, stops
from bench.service.auth.access import Access
from bench.service.auth.audit_trail import AuditTrail, AuditWriter
from bench.service.auth.token_register import REFRESH_S
from bench.service.http import conditional, exports, openapi, page, problems, turns
from bench.service.http.api_router import PREFIX
from bench.service.http.faults import Faults
from bench.service.http.guard import Guard
from bench.service.http.limits import Limits
from bench.service.lab import Lab, LabHere
from bench.service.live.live_events import LiveEvents
from bench.service.routes import (
    audit,
    bench_state,
    benches,
    challenges,
    commission,
    drive,
    effects,
    experiment_plan,
    experiments,
    leases,
    live,
    queue,
    recording_sets,
    removal,
    trials,
)
from bench.service.routes.calibration import calibrations, run
from bench.service.routes.studies import studies, study_answers, study_check, study_rounds
from bench.store import Store

DESCRIPTION = """
Test bench for one geared servo joint: run experiments, watch and stop them, read trials, and find the physical
effect that a model is missing.

* **Units** are SI and stand in every name: `load_kg`, `speed_rad_s`, `current_a`. Not measured is `null`, never 0.
* **Reading** is open on loopback. **Changing** anything (POST, PUT, DELETE) needs a token, as `Authorization: Bearer
  <token>`: the one that `friction-bench serve` printed at its first start, or one of `friction-bench token new`.
  A viewer reads and stops, an operator changes, an admin may all. Nothing that is read with GET ever moves the joint.
* **Stop**: `POST /api/v1/stop`, always, with any token.
* **Lease**: `POST /api/v1/lease` keeps the bench for one token; a start without one keeps it for the run.
* **Errors** are problem+json: `detail` is a sentence with value, limit and unit; `errors` the same, field by field.

A run, watched and read:

    POST /api/v1/experiments        {"kind": "steps", "parameters": {"repeats": 3, "load_kg": 0.1}}
    GET  /api/v1/live               server-sent events: status and rows as they are recorded
    GET  /api/v1/trials?experiment_id=1
    GET  /api/v1/trials/1/csv

Friction curves, calibrated and used:

    POST /api/v1/calibrations/run   {"accuracy_a": 0.005}; GET says how far it is; /pause, /resume
    POST /api/v1/experiments        {"kind": "speed-sweep"}
    POST /api/v1/experiments        {"kind": "load-sweep", "parameters": {"angles_rad": [0]}}
    POST /api/v1/calibrations       {"experiment_ids": [1, 2]}
    GET  /api/v1/calibrations/1/picture

A joint of your own, by questions and small motions:

    POST /api/v1/commission         {}
    GET  /api/v1/commission         step, what moves and how far, question, evidence so far
    POST /api/v1/commission/answer  {"question": 1, "value": 0.35}
    GET  /api/v1/commission/bench.toml

Many experiments, one after the other; what goes wrong holds the queue:

    POST /api/v1/queue              {"items": [{"kind": "steps"}, {"kind": "coast-down"}]}
    POST /api/v1/campaigns/plan     {"name": "loads", "kind": "reversals", "grid": {"load_kg": [0, 0.1]}}
    POST /api/v1/queue/pause        after the trial that runs; POST /api/v1/queue/resume goes on

A missing effect, found and added:

    POST /api/v1/studies            {"name": "arm", "experiment_ids": [1], "hold_out": ["load_kg=0.1"]}
    GET  /api/v1/studies/1/compare
    GET  /api/v1/studies/1/closed-loop?refine=true
    GET  /api/v1/studies/1/diagnose
    POST /api/v1/studies/1/models   {"effect": "viscous_asymmetry"}
    GET  /api/v1/studies/1/ladder
"""


_ROOMS = (
    bench_state,
    benches,
    drive,
    commission,
    leases,
    experiment_plan,
    experiments,
    queue,
    live,
    trials,
    recording_sets,
    run,
    calibrations,
    study_check,
    studies,
    study_answers,
    study_rounds,
    effects,
    challenges,
    removal,
    audit,
)


def create_app(store: Store, runner: BenchControl, access: Access, lab: Lab | None = None) -> FastAPI:
    """The service.

    Args:
        store: where trials and studies are kept; stays the caller's to close.
        runner: runs the experiments; closed (joint stopped, power off) when the application ends.
        access: tokens, hosts, and whether reading is open.
        lab: computes fits and diagnoses; closed when the application ends. In this process where left out.
    """
    trail = AuditWriter(store.access.audit.add)
    guide = Guide(runner, store)
    calibrator = Calibrator(runner, store)
    lease = Lease(lambda: _under_way(guide, calibrator, runner), engaged=lambda: guide.engaged or calibrator.engaged)
    conductor = Conductor(runner, store, lease.starting)
    places = runner.configuration.store
    shares = places.lab_url is None and places.url.startswith("postgresql")

    def is_free() -> bool:
        under_way = _under_way(guide, calibrator, runner) is not None
        return not (under_way or guide.engaged or calibrator.engaged or conductor.held or lease.current())

    work = LabWork(runner.configuration, conductor, is_free)
    link = LabLink(store, places.lab_url, partial(word_of, runner, lease, conductor), shares=shares, work=work)

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        turns.prepare()
        trail.start()
        conductor.begin()
        link.start()
        looking = asyncio.create_task(_look_again(access))
        yield
        looking.cancel()
        conductor.end()
        guide.stop(ENDED)
        calibrator.stop(ENDED)
        runner.close()
        guide.close()
        calibrator.close(ENDED)
        app.state.lab.close()
        conductor.close()
        link.close()
        trail.close()

    app = FastAPI(
        title="friction-bench",
        version=__version__,
        summary="Bench driver and test service for a geared servo joint",
        description=DESCRIPTION,
        routes=[route for module in (*_ROOMS, page) for route in module.router.routes],
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # their pages load scripts from elsewhere
        redoc_url=None,
        lifespan=lifespan,
        license_info={"name": "Apache-2.0", "identifier": "Apache-2.0"},
    )
    app.state.store, app.state.runner, app.state.access, app.state.ending = store, runner, access, False
    app.state.lease, app.state.lab_link = lease, link
    app.state.lab = lab or LabHere(store)
    app.state.conductor, app.state.guide, app.state.calibrator = conductor, guide, calibrator
    app.state.life = secrets.token_hex(4)  # tells what was told by this process from what was told before
    app.state.live_events = LiveEvents(app.state, store, runner, lease)
    compute.install(app)
    exports.install(app)
    stops.install(app)
    problems.install(app)
    conditional.install(app)
    page.install(app)
    openapi.install(app)
    app.add_middleware(Limits, access=access)
    app.add_middleware(AuditTrail, add=trail.add, strangers=access.strangers)
    app.add_middleware(Faults)
    app.add_middleware(Guard, hosts=access.hosts)
    return app


def _under_way(guide: Guide, calibrator: Calibrator, runner: BenchControl) -> int | None:
    """The experiment that runs, 0 while it has no number yet; below 0 what takes several; None where nothing does."""
    if guide.is_under_way and guide.course is not None:
        return -2 * guide.course.number
    if calibrator.is_under_way and calibrator.task is not None:
        return 1 - 2 * calibrator.task.number
    found = runner.status()
    return (found.experiment_id or 0) if found.outcome == "running" else None


async def _look_again(access: Access) -> None:
    """Keep the tokens as the store has them: one may have been revoked from outside."""
    while True:
        await anyio.to_thread.run_sync(access.look_again, abandon_on_cancel=True)
        await asyncio.sleep(REFRESH_S)
