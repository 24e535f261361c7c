"""`friction-bench run KIND`: one experiment, in this process; the options come from the kind's parameters."""

from dataclasses import replace
from enum import Enum
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.exit_codes import ExitCode
from bench.cli.operation.signals import stoppable_command, stopping_on_signals
from bench.cli.operation.watch import watch
from bench.cli.output import print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.configuration import BenchConfiguration
    from bench.experiments.kind import ExperimentKind
    from bench.json_types import Values
    from bench.runs.bench_control import RunnerStatus
    from bench.store import Experiment


class Pace(Enum):
    """How fast time passes."""

    REAL_TIME = "real-time"
    FAST = "fast"


_COMMON = {
    "operator": Annotated[str | None, typer.Option(help="Who stands at the bench; kept with the record.")],
    "note": Annotated[str | None, typer.Option(help="Kept with the record.")],
    "tags": Annotated[str | None, typer.Option(metavar="A,B,...", help="Words to find it by.")],
    "pace": Annotated[
        Pace | None,
        typer.Option(help="fast: as fast as the computer can; default on a simulated drive, and only there."),
    ],
}


class _KindGroup(TyperGroup):
    """One command per experiment kind, made when it is asked for."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002
        from bench.experiments.registry import KINDS

        return list(KINDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        from bench.cli.parameters import parameter_command
        from bench.experiments.registry import KINDS

        if cmd_name in KINDS:
            return parameter_command(KINDS[cmd_name], _run, **_COMMON)
        if not cmd_name.startswith("-"):
            ctx.fail(f"There is no experiment '{cmd_name}'; known are {', '.join(KINDS)}.")
        return None


app = typer.Typer(cls=_KindGroup, no_args_is_help=True)


@app.callback()
def _kinds() -> None:
    """Run one experiment on the bench: the joint moves. Ctrl-C stops it, and the record says so."""


def _run(
    context: typer.Context,
    kind: "ExperimentKind",
    options: dict[str, list[str]],
    operator: str | None,
    note: str | None,
    tags: str | None,
    pace: Pace | None,
    as_json: bool,
) -> None:
    from bench.cli.parameters import given
    from bench.store.tables.tags import checked

    session = session_of(context)
    words = checked(word.strip() for word in tags.split(",")) if tags else []
    found, signal_code = carry_out(
        session, kind.name, given(kind, options), operator or "", note or "", pace, quiet=as_json
    )
    if words:
        with session.open_store() as store:
            store.annotate(found.id, tags=words)
        found = replace(found, tags=tuple(words))
    _report(session, found, as_json)
    if signal_code is not None:
        raise typer.Exit(signal_code)
    if found.outcome != "completed":
        raise typer.Exit(ExitCode.NOT_COMPLETED)


def carry_out(
    session: BenchSession,
    kind: str,
    parameters: "Values",
    operator: str,
    note: str,
    pace: Pace | None,
    quiet: bool,
    hung: tuple[float, bool] | None = None,
    bench: "BenchConfiguration | None" = None,
) -> "tuple[Experiment, int | None]":
    """Run it to its end, whatever that is.

    Returns its record, and the exit code where a signal ended it. What hangs there already (load_kg, balanced) is not
    asked for again. It is run on `bench` where that is not the session's.
    """
    from bench.control import scheduling
    from bench.control.drive_factory import is_simulated
    from bench.runs.runner import HostProcess, Runner

    configuration = bench or session.configuration()
    wanted = pace or (Pace.FAST if is_simulated(configuration) else Pace.REAL_TIME)
    loop = {"process": "that of the command", "scheduling": scheduling.describe()}
    host = HostProcess(during_run=scheduling.undisturbed, facts={"control_loop": loop})
    with session.open_store() as store, stoppable_command(f"run {kind}", configuration.name):
        runner = Runner(configuration, store, host)
        try:
            with stopping_on_signals(runner) as received:
                experiment_id = runner.start(
                    kind, parameters, operator=operator, note=note, pace=wanted.value, hung=hung
                )
                watch(runner, quiet)
        finally:
            runner.close()
        return _as_it_ended(store.experiment(experiment_id), runner.status()), received.exit_code


def _as_it_ended(found: "Experiment", status: "RunnerStatus") -> "Experiment":
    """The record; where it could not be closed, on a full disk, the ending that it lacks."""
    if found.outcome != "running":
        return found
    return replace(found, outcome=status.outcome, reason=status.reason)


def _report(session: BenchSession, found: "Experiment", as_json: bool) -> None:
    if as_json:
        from bench.service.records import Experiment

        print_json(Experiment.model_validate(found).model_dump(mode="json"))
        return
    reason = f": {session.in_full(found.reason)}" if found.reason else ""
    say(f"experiment {found.id}: {found.outcome}{reason}")
    rows = [(name, value) for name, value in found.results.items() if isinstance(value, int | float | str)]
    if rows:
        table("Results", ["what", "value#"], rows)
