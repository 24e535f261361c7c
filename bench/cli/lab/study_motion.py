"""`friction-bench study ladder --motion`: every model of a study in closed loop."""

from bench.cli.bench_session import BenchSession
from bench.cli.output import say


def simulate_models(session: BenchSession, study_id: int, quiet: bool) -> None:
    """Simulate each model of a study that was not yet, and keep the error of its motion."""
    from bench.study import keep_motion_errors

    with session.open_store() as store:
        for model_id in keep_motion_errors(store, study_id):
            if not quiet:
                say(f"model {model_id} simulated")
