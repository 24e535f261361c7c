"""`friction-bench study use`, `study ladder --motion` and `--bench`: a study's models, simulated and on the bench."""

from typing import TYPE_CHECKING

import typer

from bench.cli.bench_session import BenchSession
from bench.cli.exit_codes import ExitCode
from bench.cli.operation.signals import stoppable_command, stopping_on_signals
from bench.cli.operation.watch import watch
from bench.cli.output import complain, say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.configuration import BenchConfiguration
    from bench.store import Store
    from bench.study.models.kept import Used

KIND = "sinusoid"  # accelerated motion and reversals: what a study is good for


def use_model(session: BenchSession, study_id: int, model_id: int | None) -> "Used":
    """Keep a model as a calibration, and choose it."""
    from bench.study.use import use

    with session.open_store() as store:
        return use(store, study_id, session.configuration(), model_id)


def simulate_models(session: BenchSession, study_id: int, quiet: bool) -> None:
    """Simulate each model of a study that was not yet, and keep the error of its motion."""
    from bench.study.closed_loop import keep_motion_errors

    with session.open_store() as store:
        for model_id in keep_motion_errors(store, study_id):
            if not quiet:
                say(f"model {model_id} simulated")


def measure_models(session: BenchSession, study_id: int, quiet: bool) -> float | None:
    """Move the joint once with each model of a study that has not been tried on the bench, and keep the error.

    Returns:
        The error of the reflected load without any of them, by the friction curves alone [g]; None where none was.
    """
    from bench.study.use import bench_configurations, by_curves_alone, keep_bench_error

    tried = False
    bench = session.configuration()
    with session.open_store() as store, stoppable_command("study ladder --bench", bench.name):
        for model_id, configuration in bench_configurations(store, study_id, bench):
            tried = True
            if not quiet:
                say(f"model {model_id} on the bench")
            experiment_id = _carry_out(store, configuration, quiet, "reflected load by a study's model")
            keep_bench_error(store, model_id, experiment_id)
        if not tried:
            return None
        if not quiet:
            say("the friction curves alone on the bench")
        configuration = by_curves_alone(store, bench)
        experiment_id = _carry_out(store, configuration, quiet, "reflected load by the friction curves alone")
        return 1000.0 * float(store.experiment(experiment_id).results["rms_error_kg"])


def _carry_out(store: "Store", configuration: "BenchConfiguration", quiet: bool, note: str) -> int:
    from bench.runs.runner import Runner

    runner = Runner(configuration, store)
    try:
        with stopping_on_signals(runner) as received:
            experiment_id = runner.start(KIND, {}, note=note)
            watch(runner, quiet)
    finally:
        runner.close()
    found = store.experiment(experiment_id)
    if found.outcome != "completed":
        complain(f"experiment {experiment_id}: {found.outcome}: {found.reason}")
        raise typer.Exit(received.exit_code or ExitCode.NOT_COMPLETED)
    return experiment_id
