"""First and second part: the same step again and again, and the load sweep, as figures of the paper."""

from bench.config.configuration import BenchConfiguration
from bench.evaluation.demo.bench import run_experiment
from bench.evaluation.paper import load_sweep as sweep
from bench.evaluation.paper import repeated_steps as steps
from bench.evaluation.paper.reflection import grams_per_ma
from bench.report import Section
from bench.store import Store


def repeated_steps(configuration: BenchConfiguration, store: Store) -> Section:
    """25 steps to 90 degrees at 100 g, and the current that holds the joint there (Fig. 4)."""
    experiment_id = run_experiment(configuration, store, "steps", {})
    return steps.fig_4(store.experiment(experiment_id), store.trials(experiment_id)).section


def load_sweep(configuration: BenchConfiguration, store: Store) -> Section:
    """0 to 100 g at 0 and 90 degrees (Figs 7, 8, 9 and Table 1)."""
    experiment_id = run_experiment(configuration, store, "load-sweep", {})
    experiment, trials = store.experiment(experiment_id), store.trials(experiment_id)
    table = sweep.table_1(experiment, trials).section
    hanging = sweep.fig_7(experiment, trials, grams_per_ma(configuration)).section
    raised = sweep.fig_9(experiment, trials).section
    return Section(
        title="The load sweep: 0 to 100 g at 0 and 90 degrees",
        sentences=[*hanging.sentences, *raised.sentences],
        tables=table.tables,
        figures=[*hanging.figures, *raised.figures],
    )
