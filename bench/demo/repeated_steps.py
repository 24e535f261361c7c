"""First part: 25 steps to 90 degrees at 100 g, and the current that holds the joint there (Fig. 4)."""

from bench.configuration import BenchConfiguration
from bench.demo.bench import run_experiment
from bench.report import Figure, Points, Section, Table
from bench.store import Store


def repeated_steps(configuration: BenchConfiguration, store: Store) -> Section:
    """Run the steps, and lay the compensated current beside the uncompensated one."""
    experiment_id = run_experiment(configuration, store, "steps", {})
    trials = store.trials(experiment_id)
    results = store.experiment(experiment_id).results
    event = [float(trial.conditions["repeat"]) for trial in trials]
    plain = [1e3 * trial.results["steady_current_a"] for trial in trials]
    load = [1e3 * trial.results["load_current_a"] for trial in trials]
    rows = [
        ("uncompensated", min(plain), max(plain), 1e3 * results["spread_steady_current_a"], "100 to 850"),
        ("compensated", min(load), max(load), 1e3 * results["spread_load_current_a"], "not given"),
    ]
    return Section(
        title="The same step 25 times: 0 to 90 degrees, 100 g",
        sentences=[
            "Each step approaches at another speed. Friction holds the joint wherever the servo lets it rest, so "
            "the steady current differs from step to step. The zero-speed search finds the load's share: its spread is "
            f"{results['spread_ratio']:.0f} times smaller, {1e3 * results['spread_reflected_load_kg']:.1f} g of load.",
        ],
        tables=[
            Table("Steady current [mA]", ["current", "lowest#", "highest#", "spread#", "paper, Fig. 4 (about)"], rows)
        ],
        figures=[
            Figure(
                "Steady current of each step (as the paper's Fig. 4)",
                "step",
                "current [mA]",
                [Points("uncompensated", event, plain), Points("compensated", event, load)],
            )
        ],
    )
