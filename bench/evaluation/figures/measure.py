"""Runs rigs and seeds over the cores, and makes the table."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import with_seed
from bench.evaluation.figures.rigs import drawn_rig
from bench.evaluation.figures.table import FigureRow, figures_table
from bench.evaluation.figures.trials import SeedResults, calibrated, run_rig, run_seed

CALIBRATION_SEED = 90_000  # never that of a trial
RIG_SEED = 70_000
APART = 100  # seeds of one drawn rig from those of the next: with the same noise they would err together
SHARED = 2  # seeds that one calibration of the rig of the paper serves: its error is theirs, too


def measure_figures(
    configuration: BenchConfiguration,
    seeds: int = 20,
    rigs: int = 8,
    first_seed: int = 1,
    processes: int = 2,
    show: Callable[[str], None] = lambda _line: None,
) -> list[FigureRow]:
    """Measure every figure.

    Args:
        configuration: of the simulated bench of the paper.
        seeds: of its own rig; each is a whole set of trials.
        rigs: drawn round it, one seed each.
        first_seed: of the trials; those of calibration and of the rigs follow from it.
        processes: worked on at the same time.
        show: told how far it is.
    """
    # several calibrations of one rig, since each errs in its own way for all trials after it
    starts = range(first_seed, first_seed + seeds, SHARED)
    drawn = [drawn_rig(configuration, RIG_SEED + first_seed + rig) for rig in range(rigs)]
    # spawned: a forked child would inherit threads of whoever calls
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        rigs_under_way = [
            pool.submit(run_rig, one, CALIBRATION_SEED + first_seed + APART * rig, first_seed + APART * rig)
            for rig, one in enumerate(drawn)
        ]
        known = list(pool.map(calibrated, [with_seed(configuration, CALIBRATION_SEED + start) for start in starts]))
        show(f"{len(known)} calibrations of rig '{configuration.rig.name}'")
        own = [with_seed(known[place // SHARED], first_seed + place) for place in range(seeds)]
        found = _shown(own, pool.map(run_seed, own), show)
        found_rigs = _shown(drawn, (one.result() for one in rigs_under_way), show)
    return figures_table(own[0], found, drawn, found_rigs)


def _shown(
    benches: Sequence[BenchConfiguration], results: Iterable[SeedResults], show: Callable[[str], None]
) -> list[SeedResults]:
    """The results, each shown as it comes."""
    found = []
    for place, (bench, result) in enumerate(zip(benches, results, strict=True), 1):
        found.append(result)
        show(_progress(place, len(benches), bench, result))
    return found


def _progress(done: int, of: int, task: BenchConfiguration, result: SeedResults) -> str:
    failures: Sequence[str] = [f"{name}: {why}" for name, why in result.failures.items()]
    return f"{done} of {of}: rig '{task.rig.name}'" + (f"; without {'; '.join(failures)}" if failures else "")
