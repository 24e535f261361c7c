"""`friction-bench study ...`: compare, simulate, diagnose, suggest, add, drop, search, ladder, report."""

from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Concatenate, ParamSpec, TypeVar

import typer

from bench.cli.bench_session import session_of
from bench.cli.evaluation.cores import Cluster, Workers, progress
from bench.cli.lab import diagnosis_tables, study_tables
from bench.cli.operation.service import DEFAULT_URL, Url
from bench.cli.output import Json, free_page, print_json, refuse_taken, say, table, write_whole

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.store import Store
    from bench.study.models.change import Changed
    from bench.study.models.diagnosis import Diagnosis
    from bench.study.models.study import Study

P = ParamSpec("P")
T = TypeVar("T")
app = typer.Typer(no_args_is_help=True)
StudyId = Annotated[int, typer.Argument(metavar="STUDY", help="Number of the study.")]
Effect = Annotated[str, typer.Argument(help="Name of the effect; list them with: friction-bench effects")]
Model = Annotated[int | None, typer.Option(help="Which model; without it, the newest of the study.")]

_HOLD_OUT = (
    "Trials that judge the model instead of being fitted; KEY is a condition, `trial` or `kind`; repeatable. "
    "Without it, each trial is left out in turn."
)
_WHERE = "Use only trials of which this holds; repeatable."
_LEAVE_OUT = "Name of a trial that is not used, such as one that was disturbed; repeatable."
_START = (
    "Run them: the joint moves. After each round add what completed to the study, diagnose, and suggest anew; what "
    "trips or is refused is replaced by the next best."
)
_AT_ONCE = "Trials of a round, with --start."
_QUEUE = "Put them into the queue of the service that runs, on the same store; then `study extend` adds what completed."
_REPORT = "File to write; without it study-N.html, or study-N-2.html and so on where that is there."
_BENCH = "Move the joint once with each model not tried yet: the error of the reflected load, in grams."
_MOTION = "Simulate each model not simulated yet in closed loop: the error of the motion."
_REFINE = "Refine the coefficients by it, too: the effort regressed along the simulated motion; nothing is kept."
_EXTEND = "Experiment whose trials are added; repeatable. Without it, those that were run for the study."
_BASE = "Effect of the first model; repeatable. Without it, the rigid joint with General Kinetic Friction."


class Rows(Enum):
    """Which rows count."""

    SLIDING = "sliding"
    MOVING = "moving"
    ALL = "all"


@app.callback()
def _study() -> None:
    """Compare measured with predicted, name the missing effect, add it, watch the error fall."""


@app.command("new")
def new_command(
    context: typer.Context,
    name: Annotated[str, typer.Argument(help="Name of the study.")],
    experiment: Annotated[list[int], typer.Option(help="Experiment whose trials are used; repeatable.")],
    hold_out: Annotated[list[str] | None, typer.Option(metavar="KEY=VALUE", help=_HOLD_OUT)] = None,
    where: Annotated[list[str] | None, typer.Option(metavar="KEY=VALUE", help=_WHERE)] = None,
    leave_out: Annotated[list[str] | None, typer.Option(metavar="TRIAL", help=_LEAVE_OUT)] = None,
    base: Annotated[list[str] | None, typer.Option(help=_BASE)] = None,
    rows: Annotated[Rows, typer.Option(help="Which rows count in fit and error.")] = Rows.SLIDING,
    cutoff_hz: Annotated[float | None, typer.Option(help="Low-pass [Hz]; without it, chosen from the data.")] = None,
    as_json: Json = False,
) -> None:
    """Create a study: which trials are fitted, and which judge the fit."""
    from bench.study.create import create_study

    session = session_of(context)

    def show(found: "Study") -> None:
        study_tables.study(found)
        say(session.in_full(f"next: friction-bench study diagnose {found.study_id}"))

    _show(
        context,
        as_json,
        show,
        create_study,
        name,
        experiment,
        hold_out=hold_out or [],
        base=base or None,
        where=where or [],
        cutoff_hz=cutoff_hz,
        rows=rows.value,
        leave_out=leave_out or [],
    )


@app.command("list")
def list_(context: typer.Context, as_json: Json = False) -> None:
    """List the studies."""
    with session_of(context).open_store() as store:
        found = store.studies()
    if as_json:
        print_json([{"study_id": one.id, "name": one.name, "created_utc": one.created_utc} for one in found])
    else:
        table("Studies", ["id#", "name", "created"], [(one.id, one.name, one.created_utc) for one in found])


@app.command("compare")
def compare_command(context: typer.Context, study: StudyId, model: Model = None, as_json: Json = False) -> None:
    """Measured against predicted: error per trial and regime, parameters, the floor."""
    from bench.study.compare import compare

    _show(context, as_json, study_tables.comparison, compare, study, model)


@app.command("coverage")
def coverage_command(context: typer.Context, study: StudyId, model: Model = None, as_json: Json = False) -> None:
    """What the trials can and cannot tell: directions, speeds, loads, repeats; which effects look alike in them."""
    from bench.study.explanation.coverage import coverage

    _show(context, as_json, study_tables.coverage, coverage, study, model)


@app.command("simulate")
def simulate_command(
    context: typer.Context,
    study: StudyId,
    model: Model = None,
    refine: Annotated[bool, typer.Option("--refine", help=_REFINE)] = False,
    as_json: Json = False,
) -> None:
    """The model under the servo that the trials ran under: does it go where the joint went."""
    from bench.study.closed_loop import simulate

    _show(context, as_json, study_tables.simulation, simulate, study, model, refine)


@app.command("diagnose")
def diagnose_command(context: typer.Context, study: StudyId, model: Model = None, as_json: Json = False) -> None:
    """Which physical effect is missing, how sure is that, and what would adding it bring.

    Gains count each row by how well it is known, errors count all alike; effects near reversals and at starts from
    rest have errors of their own rows.
    """
    from bench.study.diagnosis.diagnose import diagnose

    session = session_of(context)

    def show(found: "Diagnosis") -> None:
        diagnosis_tables.diagnosis(found)
        say(session.in_full(diagnosis_tables.next_step(found, model)))

    _show(context, as_json, show, diagnose, study, model)


@app.command("diagnose-many")
def diagnose_many_command(
    context: typer.Context,
    studies: Annotated[list[int] | None, typer.Argument(metavar="[STUDY]...", help="Without any, all.")] = None,
    workers: Workers = None,
    cluster: Cluster = None,
    as_json: Json = False,
) -> None:
    """Diagnose the newest models of many studies, on all cores or on a cluster."""
    from bench.parallel.over_cores import start_early

    start_early("bench.study.diagnosis.diagnose_many", workers, cluster)

    from bench.study.diagnosis.diagnose_many import diagnose_many

    with session_of(context).open_store() as store:
        chosen = studies or sorted(row.id for row in store.studies())
        found = diagnose_many(store, chosen, progress, workers, cluster)
    print_json(found) if as_json else diagnosis_tables.diagnoses(found)


@app.command("units")
def units_command(
    context: typer.Context,
    study: StudyId,
    beside: Annotated[list[int], typer.Argument(metavar="STUDY...", help="One study for each other unit.")],
    model: Model = None,
    as_json: Json = False,
) -> None:
    """Units of one kind, fitted with the study's model: what is common, how they scatter, which is an outlier.

    Of two units: by how much each parameter differs, with its 90 % interval.
    """
    from bench.study.units import compare_units

    _show(context, as_json, study_tables.units, compare_units, study, beside, model)


@app.command("add")
def add_command(
    context: typer.Context, study: StudyId, effect: Effect, model: Model = None, as_json: Json = False
) -> None:
    """Add an effect to a model and refit: the error before and after."""
    from bench.study.changes import add_effect

    session = session_of(context)

    def show(found: "Changed") -> None:
        study_tables.change(found)
        say(session.in_full(f"next: friction-bench study diagnose {study}"))
        say(
            session.in_full(f"score and p of {effect}: friction-bench study diagnose {study} --model {found.parent_id}")
        )

    _show(context, as_json, show, add_effect, study, effect, model)


@app.command("drop")
def drop(context: typer.Context, study: StudyId, effect: Effect, model: Model = None, as_json: Json = False) -> None:
    """Drop an effect from a model and refit: the error before and after."""
    from bench.study.changes import drop_effect

    _show(context, as_json, study_tables.change, drop_effect, study, effect, model)


@app.command("search")
def search_command(
    context: typer.Context,
    study: StudyId,
    model: Model = None,
    most: Annotated[int, typer.Option(min=1, max=10, help="Effects that are added at most.")] = 4,
    as_json: Json = False,
) -> None:
    """Add effects one after the other until nothing is missing; each step is a rung of the ladder."""
    from bench.study.diagnosis.search import search_and_diagnose

    session = session_of(context)
    with session.open_store() as store:
        found, last = search_and_diagnose(store, study, model, most)
    if as_json:
        print_json(found)
        return
    of_model = None if found.steps else model
    diagnosis_tables.search(found)
    if unjudged := diagnosis_tables.not_judged(last, of_model):
        say(session.in_full(unjudged))
    say(session.in_full(diagnosis_tables.next_step(last, of_model)))


@app.command("suggest")
def suggest_command(
    context: typer.Context,
    study: StudyId,
    model: Model = None,
    trials: Annotated[int, typer.Option(min=1, max=50, help="Trials at most.")] = 6,
    start: Annotated[bool, typer.Option("--start", help=_START)] = False,
    at_once: Annotated[int, typer.Option(min=1, max=50, help=_AT_ONCE)] = 2,
    queue: Annotated[bool, typer.Option("--queue", help=_QUEUE)] = False,
    url: Url = DEFAULT_URL,
    as_json: Json = False,
) -> None:
    """Which trials would tell the rivals apart: of the bench's own kinds, inside its limits, by d' per minute."""
    from bench.cli.lab.study_trials import carry_out_all, queue_all, suggested

    if start and queue:
        raise typer.BadParameter("--start runs the trials here, --queue on the service: give one of them")
    if start:
        carry_out_all(session_of(context), study, model, trials, at_once, as_json)
        return
    session = session_of(context)
    found = suggested(session, study, model, trials)
    if queue:
        queue_all(session, found, url, as_json)
    elif as_json:
        print_json(found)
    else:
        diagnosis_tables.suggestion(found)
        for line in diagnosis_tables.commands(found):
            say(session.in_full(line))


@app.command("extend")
def extend_command(
    context: typer.Context,
    study: StudyId,
    experiment: Annotated[list[int] | None, typer.Option(help=_EXTEND)] = None,
    as_json: Json = False,
) -> None:
    """Add trials to a study and refit its newest model to all of them."""
    from bench.study.extend import extend_study

    _show(context, as_json, diagnosis_tables.extended, extend_study, study, experiment or [])


@app.command("refit")
def refit_command(
    context: typer.Context,
    study: StudyId,
    experiment: Annotated[list[int], typer.Option(help="Experiment whose trials are read; repeatable.")],
    model: Model = None,
    as_json: Json = False,
) -> None:
    """Fit a model anew to all trials of experiments, however many rows they have; nothing is kept."""
    from bench.study.refit import refit

    _show(context, as_json, study_tables.refitted, refit, study, experiment, model)


@app.command("use")
def use_command(context: typer.Context, study: StudyId, model: Model = None, as_json: Json = False) -> None:
    """Hand a model to the online compensator: the load in motion is estimated with it from now on."""
    from bench.cli.lab.study_bench import use_model

    found = use_model(session_of(context), study, model)
    print_json(found) if as_json else say(found.sentence)


@app.command("report")
def report_command(
    context: typer.Context,
    study: StudyId,
    html: Annotated[Path | None, typer.Option(help=_REPORT)] = None,
    suggest: Annotated[bool, typer.Option(help="Say which trials to record next; takes longer.")] = True,
) -> None:
    """One HTML file to be filed: trials, ladder, model, pictures, diagnosis, what to record next, provenance."""
    from bench.study.report.report import report_html

    report = html or free_page(f"study-{study}")
    refuse_taken(report)  # before the time that a report takes
    session = session_of(context)
    with session.open_store() as store:
        page = report_html(store, study, session.configuration() if suggest else None)
    write_whole(report, [page.encode()])
    say(f"written: {report}")


@app.command("ladder")
def ladder_command(
    context: typer.Context,
    study: StudyId,
    bench: Annotated[bool, typer.Option("--bench", help=_BENCH)] = False,
    motion: Annotated[bool, typer.Option("--motion", help=_MOTION)] = False,
    as_json: Json = False,
) -> None:
    """The error from model to model, training and held-out, down towards the floor; in motion; in grams."""
    if motion:
        from bench.cli.lab.study_bench import simulate_models

        simulate_models(session_of(context), study, quiet=as_json)
    alone_g = None
    if bench:
        from bench.cli.lab.study_bench import measure_models

        alone_g = measure_models(session_of(context), study, quiet=as_json)
    from bench.study.ladder import ladder

    _show(context, as_json, study_tables.ladder, ladder, study)
    if alone_g is not None and not as_json:
        say(f"reflected load by the friction curves alone, without a model of the study: error {alone_g:.4g} g")


def _show(
    context: typer.Context,
    as_json: bool,
    show: Callable[[T], None],
    function: Callable[Concatenate["Store", P], T],
    *args: P.args,
    **kwargs: P.kwargs,
) -> None:
    """Ask the study on the store of this session, and print the answer."""
    with session_of(context).open_store() as store:
        found = function(store, *args, **kwargs)
    print_json(found) if as_json else show(found)
