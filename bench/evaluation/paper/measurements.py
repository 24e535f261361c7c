"""The experiments behind the page: run, or found again in the store."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.calibration import calibrate
from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import reflected_load_kg
from bench.control.drive_factory import is_simulated
from bench.errors import ConfigurationError, ExperimentError
from bench.experiments.kinds.steady_speeds import PAPER_SPEEDS_RAD_S
from bench.experiments.parts.at_rest import RIGHT_ANGLE_RAD
from bench.experiments.registry import whole_parameters
from bench.json_types import Value, Values
from bench.runs.bench_control import Pace
from bench.runs.runner import Runner
from bench.store import CalibrationRow, Experiment, Store
from bench.store.errors import NotFoundError

WALL_RAD = 0.8
WALL_REACH_S = 3.0  # gently: an arm that hits a wall wedges its gear
Conduct = Callable[[Runner], None]
"""Waits for the end of what a runner has started, and shows it or not."""


def quietly(runner: Runner) -> None:
    """A `Conduct` that shows nothing."""
    runner.wait()


@dataclass(frozen=True)
class Measurement:
    """One experiment that a page needs.

    Attributes:
        kind: of the experiment.
        parameters: what differs from the kind's defaults.
    """

    kind: str
    parameters: Values


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    Attributes:
        loads_kg: of the sweeps, from nothing to the heaviest.
        steps: repeated steps under the heaviest load (Fig. 4).
        trials: repeated steps under one load in the middle (Fig. 10).
        speeds_rad_s: of the joint (Fig. 11).
        periods: of the sinusoid.
        speed_sweep: further parameters of the speed sweep.
        reaches_rad, wall_reaches_rad: angles that the operator of the master reaches for: with a weight on the slave,
            and with a wall in its way.
        largest_force_scale: that is tried at rest.
    """

    loads_kg: tuple[float, ...] = tuple(round(0.01 * step, 2) for step in range(11))
    steps: int = 25
    trials: int = 11
    speeds_rad_s: tuple[float, ...] = PAPER_SPEEDS_RAD_S
    periods: int = 4
    # what has not saturated after four strokes still counts: its inertia is taken off
    speed_sweep: tuple[tuple[str, Any], ...] = (("duties", (0.1, 0.2, 0.3)), ("strokes", 4))

    reaches_rad: tuple[float, ...] = (1.2, 0.6, 1.5, -0.8)
    wall_reaches_rad: tuple[float, ...] = (0.83, 0.4, 0.85)
    largest_force_scale: float = 20.0

    @property
    def middle_kg(self) -> float:
        """The load of Fig. 10 and Fig. 11."""
        return self.loads_kg[len(self.loads_kg) // 2]

    def measurements(self) -> dict[str, Measurement]:
        """By the name under which the page asks for them, in the order in which they are run.

        The loads of the calibration are known to it; those of the load sweep after it are not: they are hung anew.
        """
        sweep = {"loads_kg": self.loads_kg, **dict(self.speed_sweep)}
        loads: dict[str, Value] = {"loads_kg": self.loads_kg, "angles_rad": (0.0, pi / 2)}
        return {
            "speed-sweep": Measurement("speed-sweep", sweep),
            "known-loads": Measurement("load-sweep", {**loads, "searches": 1}),
            "load-sweep": Measurement("load-sweep", {**loads, "searches": 2}),
            "steps": Measurement("steps", {"load_kg": self.loads_kg[-1], "repeats": self.steps}),
            "trials": Measurement("steps", {"load_kg": self.middle_kg, "repeats": self.trials}),
            "steady-speeds": Measurement(
                "steady-speeds", {"load_kg": self.middle_kg, "speeds_rad_s": self.speeds_rad_s}
            ),
            "sinusoid": Measurement("sinusoid", {"load_kg": self.middle_kg, "periods": self.periods}),
            "teleoperation": Measurement(
                "teleoperation",
                {
                    "load_kg": self.loads_kg[-1],
                    "angles_rad": self.reaches_rad,
                    "find_margin": True,
                    "largest_force_scale": self.largest_force_scale,
                },
            ),
            "wall": Measurement(
                "teleoperation",
                {
                    "load_kg": self.middle_kg,
                    "angles_rad": self.wall_reaches_rad,
                    "wall_rad": WALL_RAD,
                    "reach_s": WALL_REACH_S,
                },
            ),
        }


def measure(
    configuration: BenchConfiguration, store: Store, wanted: Measurement, conduct: Conduct, operator: str = ""
) -> Experiment:
    """Run an experiment; on a simulated bench as fast as it goes.

    Raises:
        ExperimentError: it did not complete.
    """
    runner = Runner(configuration, store)
    try:
        pace: Pace | None = "fast" if is_simulated(configuration) else None
        started = runner.start(wanted.kind, wanted.parameters, operator=operator, pace=pace)
        conduct(runner)
        runner.wait()
    finally:
        runner.close()
    found = store.experiment(started)
    if found.outcome != "completed":
        raise ExperimentError(f"experiment {started} ({wanted.kind}): {found.outcome}: {found.reason}")
    return found


@contextmanager
def own_store() -> Iterator[Store]:
    """A store that is gone afterwards."""
    with (
        TemporaryDirectory(prefix="friction-bench-") as folder,
        Store.open(f"sqlite:///{Path(folder) / 'own.sqlite'}") as store,
    ):
        yield store


def recorded(store: Store, wanted: Measurement) -> Experiment:
    """The newest completed experiment of these very parameters, whoever started it.

    Raises:
        NotFoundError: there is none.
    """
    parameters = whole_parameters(wanted.kind, wanted.parameters)
    for found in store.experiments(kind=wanted.kind, outcome="completed"):
        if found.parameters == parameters:
            return found
    raise NotFoundError(
        f"the store has no completed experiment '{wanted.kind}' with parameters {parameters}; run the page's "
        "experiments first: friction-bench paper"
    )


def calibration_of(store: Store, experiments: list[Experiment]) -> CalibrationRow:
    """The calibration made from these experiments; made now where it is not kept yet."""
    ids = [one.id for one in experiments]
    for found in store.calibrations.find():
        if found.experiment_ids == ids:
            return found
    return store.calibrations.get(calibrate(store, ids, note="friction-bench paper"))


def grams_per_ma(configuration: BenchConfiguration) -> float:
    """Grams at the tip that a milliampere holds at 90 degrees, an arm of its own weight aside.

    Raises:
        ConfigurationError: the rig lacks what turns a current into a load.
    """
    one_a, nothing = (reflected_load_kg(current_a, RIGHT_ANGLE_RAD, configuration.rig) for current_a in (1.0, 0.0))
    if one_a is None or nothing is None:
        raise ConfigurationError("at 90 degrees gravity has a lever; a rig without one cannot reflect a load")
    return one_a - nothing
