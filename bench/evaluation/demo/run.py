"""Runs the demo and writes its report."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from bench.config.configuration import BenchConfiguration, default_configuration
from bench.evaluation.demo.hidden_effect import hidden_effect
from bench.evaluation.paper import load_sweep as sweep
from bench.evaluation.paper import repeated_steps as steps
from bench.evaluation.paper.measurements import Measurement, grams_per_ma, measure, quietly
from bench.report import Section, write_html
from bench.store import Store


def repeated_steps(configuration: BenchConfiguration, store: Store) -> Section:
    """25 steps to 90 degrees at 100 g, and the current that holds the joint there (Fig. 4)."""
    experiment = measure(configuration, store, Measurement("steps", {}), quietly, "demo")
    return steps.fig_4(experiment, store.trials(experiment.id)).section


def load_sweep(configuration: BenchConfiguration, store: Store) -> Section:
    """0 to 100 g at 0 and 90 degrees (Figs 7, 8, 9 and Table 1)."""
    experiment = measure(configuration, store, Measurement("load-sweep", {}), quietly, "demo")
    trials = store.trials(experiment.id)
    table = sweep.table_1(experiment, trials).section
    hanging = sweep.fig_7(experiment, trials, grams_per_ma(configuration)).section
    raised = sweep.fig_9(experiment, trials).section
    return Section(
        title="The load sweep: 0 to 100 g at 0 and 90 degrees",
        sentences=[*hanging.sentences, *raised.sentences],
        tables=table.tables,
        figures=[*hanging.figures, *raised.figures],
    )


DEFAULT_SEED = 2
TITLE = "friction-bench: the main job on the simulated bench"


def run_demo(report: Path, show: Callable[[Section], None], seed: int = DEFAULT_SEED) -> Path:
    """Run the main job end to end.

    Args:
        report: HTML file to write; the trials go to a store beside it, made afresh.
        show: called with every section as soon as it is there.
        seed: of the hidden effect.

    Returns:
        The store.
    """
    database = report.with_suffix(".sqlite")
    database.parent.mkdir(parents=True, exist_ok=True)
    for leftover in (database, *(database.with_name(database.name + end) for end in ("-wal", "-shm"))):
        leftover.unlink(missing_ok=True)
    configuration = default_configuration()
    store = Store.open(f"sqlite:///{database}")
    try:
        sections: list[Section] = []
        parts = (repeated_steps, load_sweep, partial(hidden_effect, seed=seed))
        for part in parts:
            sections.append(part(configuration, store))
            show(sections[-1])
    finally:
        store.close()
    write_html(report, TITLE, sections)
    return database
