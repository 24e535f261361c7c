"""Runs one experiment of the demo to its end."""

from typing import Any

from bench.config.configuration import BenchConfiguration
from bench.errors import ExperimentError
from bench.runs.runner import Runner
from bench.store import Store


def run_experiment(configuration: BenchConfiguration, store: Store, kind: str, parameters: dict[str, Any]) -> int:
    """Run an experiment as fast as the simulation goes. Returns its id.

    Raises:
        ExperimentError: it did not complete.
    """
    runner = Runner(configuration, store)
    try:
        experiment_id = runner.start(kind, parameters, operator="demo", pace="fast")
        runner.wait()
    finally:
        runner.close()
    experiment = store.experiment(experiment_id)
    if experiment.outcome != "completed":
        raise ExperimentError(f"{kind}: {experiment.outcome}: {experiment.reason}")
    return experiment_id
