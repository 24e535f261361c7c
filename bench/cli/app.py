"""The commands and the options that stand before them."""

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from bench.cli.bench_session import BenchSession
from bench.cli.evaluation import bench_report, blind, demo, figures, paper, rivals
from bench.cli.exit_codes import HELP, errors_as_messages
from bench.cli.lab import challenge, effects, study
from bench.cli.operation import audit, calibrate, campaign, doctor, queue, run, serve, service, simulate_device, token
from bench.cli.output import say
from bench.cli.records import experiments, recordings, trials
from bench.cli.records import store as store_commands  # `store` is an option of every command

_ORDER = (
    "demo",
    "paper",
    "rivals",
    "figures",
    "serve",
    "doctor",
    "run",
    "queue",
    "campaign",
    "status",
    "stop",
    "experiments",
    "trials",
    "trial",
    "export",
    "import",
    "calibrate",
    "study",
    "store",
    "token",
    "audit",
    "effects",
    "simulate-device",
    "challenge",
    "reveal",
    "blind",
    "bench-report",
)


class _Group(TyperGroup):
    """Errors of every command end here; the help lists them in the order of their use."""

    def list_commands(self, ctx: Any) -> list[str]:
        return sorted(super().list_commands(ctx), key=_ORDER.index)

    def invoke(self, ctx: Any) -> Any:
        with errors_as_messages():
            return super().invoke(ctx)


app = typer.Typer(
    cls=_Group, name="friction-bench", no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode="markdown"
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        say(f"friction-bench {version('friction-bench')}")
        raise typer.Exit


@app.callback(epilog=HELP)
def options(
    context: typer.Context,
    config: Annotated[
        Path | None,
        typer.Option(envvar="FRICTION_BENCH_CONFIG", help="bench.toml; without it the simulated bench of the paper."),
    ] = None,
    store: Annotated[
        str | None,
        typer.Option(
            envvar="FRICTION_BENCH_STORE",
            help="SQLite file or database URL; without it friction-bench.sqlite in the working directory.",
        ),
    ] = None,
    log: Annotated[
        str | None,
        typer.Option(
            envvar="FRICTION_BENCH_LOG",
            help="File that gets what happens, one JSON object a line: runs, requests that change something, errors; "
            "- for stderr.",
        ),
    ] = None,
    version: Annotated[  # noqa: ARG001  its callback has done it
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Test bench for a geared servo joint: run experiments, and find the effect that a model is missing.

    Start with `friction-bench demo`, or `friction-bench serve` and open the page that it names.
    """
    context.obj = BenchSession(config, store)
    if log:
        from bench.runs import event_log  # imported when needed: `--help` starts at once

        event_log.begin(log)


app.command("serve")(serve.serve)
app.command("doctor")(doctor.doctor)
app.add_typer(run.app, name="run")
app.add_typer(queue.app, name="queue")
app.add_typer(campaign.app, name="campaign")
app.command("status")(service.status)
app.command("stop")(service.stop)
app.command("experiments")(experiments.experiments)
app.command("trials")(trials.trials)
app.command("trial")(trials.trial)
app.command("export")(recordings.export)
app.command("import")(recordings.import_)
app.add_typer(calibrate.app, name="calibrate")
app.add_typer(study.app, name="study")
app.add_typer(store_commands.app, name="store")
app.add_typer(token.app, name="token")
app.command("audit")(audit.audit)
app.command("effects")(effects.effects)
app.command("demo")(demo.demo)
app.command("figures")(figures.figures)
app.command("paper")(paper.paper)
app.command("rivals")(rivals.rivals)
app.add_typer(simulate_device.app, name="simulate-device")
app.command("challenge")(challenge.challenge)
app.command("reveal")(challenge.reveal)
app.command("blind")(blind.blind)
app.command("bench-report")(bench_report.bench_report)


def main() -> None:
    """Entry point of the console script."""
    app()
