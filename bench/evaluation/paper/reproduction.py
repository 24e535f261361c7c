"""The page: its experiments, then its rows in the order of the paper."""

from collections.abc import Callable, Sequence

from bench.calibration import with_calibration
from bench.config.configuration import BenchConfiguration
from bench.evaluation.paper import load_sweep, repeated_steps
from bench.evaluation.paper.accelerated import accelerated
from bench.evaluation.paper.friction_curves import friction_curves
from bench.evaluation.paper.measurements import Conduct, Plan, calibration_of, grams_per_ma, measure, quietly, recorded
from bench.evaluation.paper.row import Row
from bench.evaluation.paper.steady_speeds import fig_11
from bench.evaluation.paper.teleoperation import teleoperation
from bench.report import Section, Table
from bench.store import Experiment, Store

WHOLE = Plan()


def summary(rows: Sequence[Row]) -> Section:
    """The first section of the page: every number, and what is not shown."""
    lines = [line for row in rows for line in row.lines()]
    return Section(
        title="Every number, ours and the paper's",
        sentences=[
            "Saini, Sarkar, Datta Ray: Friction Compensation for Sensor-Less Force Reflection in Servo Manipulators "
            "for High Radiation Areas. AIR '13, doi 10.1145/2506095.2506138.",
            "The paper's numbers are those of its Table 1, or read off its figures; '-' where it gives none. Every "
            "figure is drawn from recorded trials, named with it, and can be drawn again from the store: "
            "friction-bench paper --from-store.",
        ],
        tables=[Table("Ours and the paper's", ["figure", "quantity", "ours#", "paper#"], lines)],
    )


def reproduce(
    configuration: BenchConfiguration,
    store: Store,
    from_store: bool = False,
    plan: Plan = WHOLE,
    conduct: Conduct = quietly,
    show: Callable[[Row], None] = lambda _row: None,
) -> list[Row]:
    """Every row of the page.

    Args:
        configuration: of the bench.
        store: where its trials are kept.
        from_store: run nothing; draw the newest experiments of the same parameters.
        plan: how much is measured.
        conduct: watches each experiment.
        show: called with each row as soon as it is there.

    Raises:
        ConfigurationError: the rig lacks what turns a current into a load.
        ExperimentError: an experiment did not complete.
        NotFoundError: `from_store`, and an experiment is not there.
    """
    rows: list[Row] = []

    def add(made: Sequence[Row]) -> None:
        for row in made:
            rows.append(row)
            show(row)

    wanted = plan.measurements()
    per_ma_g = grams_per_ma(configuration)

    def experiment(name: str) -> Experiment:
        if from_store:
            return recorded(store, wanted[name])
        return measure(configuration, store, wanted[name], conduct)

    found = calibration_of(store, [experiment("speed-sweep"), experiment("known-loads")])
    configuration = with_calibration(configuration, found)
    add(friction_curves(found))
    steps = experiment("steps")
    add([repeated_steps.fig_4(steps, store.trials(steps.id))])
    loads = experiment("load-sweep")
    trials = store.trials(loads.id)
    add([load_sweep.fig_7(loads, trials, per_ma_g), load_sweep.table_1(loads, trials), load_sweep.fig_9(loads, trials)])
    again = experiment("trials")
    add([repeated_steps.fig_10(again, store.trials(again.id), per_ma_g)])
    add([fig_11(store, experiment("steady-speeds")), accelerated(store, experiment("sinusoid"))])
    if configuration.master is not None:
        add([teleoperation(store, experiment("teleoperation"), experiment("wall"))])
    return rows
