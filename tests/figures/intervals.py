"""`python -m tests.figures.intervals RIGS CALIBRATIONS [FIRST_SEED [SIDES]]`: do the 95 % intervals hold the truth?

First the binomial law: how likely is a rig whose intervals are exactly right to come out within 92 .. 98 %, and how
many trials does it take until 18 of 20 such rigs do? Then rigs drawn at random, each calibrated several times: what
each holds, and what it missed after each calibration, whose error all trials after it have in common. By how much the
misses scatter more than chance (the design effect: Kish, "Survey Sampling", 1965, chapter 5.4) says by how many more
trials the law is fulfilled. SIDES is 2; with 1, loads are calibrated at angles above 0 alone, with as many trials.
"""

import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from math import ceil, floor
from multiprocessing import get_context
from pathlib import Path
from statistics import fmean, variance
from tempfile import TemporaryDirectory

from scipy.stats import binom

from bench.config.configuration import BenchConfiguration, default_configuration
from bench.control.drive_factory import with_seed
from bench.evaluation.figures.coverage import Share, held
from bench.evaluation.figures.measure import APART, CALIBRATION_SEED, RIG_SEED
from bench.evaluation.figures.rigs import drawn_rig
from bench.evaluation.figures.trials import AT_REST, RIGHT_ANGLE_RAD, calibrated_at_rest, drawn_loads
from bench.evaluation.paper.measurements import Measurement, measure, quietly
from bench.store import Store

LOW, HIGH, ASKED = 0.92, 0.98, 0.95
ROUNDED = 1e-9


def is_within(share: Share) -> bool:
    """Whether it is within what is asked for."""
    return LOW * share.trials - ROUNDED <= share.held <= HIGH * share.trials + ROUNDED


def chance_within(trials: int, covered: float = ASKED) -> float:
    """That a rig whose intervals hold the truth with probability `covered` comes out within what is asked for."""
    least, most = ceil(LOW * trials - ROUNDED), floor(HIGH * trials + ROUNDED)
    return float(binom.cdf(most, trials, covered) - binom.cdf(least - 1, trials, covered))


def design_effect(clusters: Sequence[Sequence[Share]]) -> float:
    """Variance of the misses after a calibration over that of independent trials, mean over the rigs.

    Args:
        clusters: of each rig, its trials after each calibration.
    """
    ratios = []
    for shares in clusters:
        missed = [one.trials - one.held for one in shares]
        trials = fmean(one.trials for one in shares)
        chance = fmean(missed) / trials
        if 0.0 < chance < 1.0:
            ratios.append(variance(missed) / (trials * chance * (1.0 - chance)))
    return fmean(ratios)


def law() -> Iterator[str]:
    """The lines of the binomial law."""
    yield f"{'trials':>6} {'one rig within':>14} {'18 of 20 within':>15}   of intervals that are exactly right"
    for trials in (25, 50, 100, 150, 200, 300, 400):
        one = chance_within(trials)
        yield f"{trials:6} {100.0 * one:12.1f} % {100.0 * float(binom.sf(17, 20, one)):13.1f} %"


def at_rest(sides: int) -> Measurement:
    """What a rig is calibrated from, with loads on both sides or on one, as many trials either way."""
    other_rad = -RIGHT_ANGLE_RAD if sides == 2 else RIGHT_ANGLE_RAD
    return Measurement(AT_REST.kind, {**AT_REST.parameters, "angles_rad": (0.0, RIGHT_ANGLE_RAD, other_rad)})


def shares_of(task: tuple[BenchConfiguration, int, int, int]) -> tuple[Share, Share]:
    """Trials at random loads and angles after one calibration of a rig: at angles above 0, and below."""
    bench, calibration_seed, seed, sides = task
    known = with_seed(calibrated_at_rest(with_seed(bench, calibration_seed), at_rest(sides)), seed)
    with TemporaryDirectory() as folder, Store.open(f"sqlite:///{Path(folder) / 'trials.sqlite'}") as store:
        rows = measure(known, store, drawn_loads(seed), quietly).results["rows"]
    above, below = ([row for row in rows if (row["angle_rad"] > 0.0) is up] for up in (True, False))
    return held(above, known.rig), held(below, known.rig)


def total(shares: Iterable[Share]) -> Share:
    """All of them together."""
    found = list(shares)
    return Share(sum(one.held for one in found), sum(one.trials for one in found))


def _told(above: Sequence[Share], below: Sequence[Share]) -> str:
    whole = total([*above, *below])
    low, high = whole.interval()
    sides = f"above {_per_cent(total(above))}, below {_per_cent(total(below))}"
    return f"{_per_cent(whole)} of {whole.trials} ({100.0 * low:.1f} .. {100.0 * high:.1f}); {sides}"


def _per_cent(share: Share) -> str:
    return f"{100.0 * share.held / share.trials:5.1f} %" if share.trials else "-"


def main(rigs: int, calibrations: int, first_seed: int = 1, sides: int = 2) -> None:
    """Print both, the law first."""
    print("\n".join(law()), flush=True)
    plain = default_configuration()
    benches = [drawn_rig(plain, RIG_SEED + first_seed + rig) for rig in range(rigs)]
    tasks = [
        (bench, CALIBRATION_SEED + first_seed + APART * rig + again, first_seed + APART * rig + again, sides)
        for rig, bench in enumerate(benches)
        for again in range(calibrations)
    ]
    within, clusters, above, below = 0, [], [], []
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        results = pool.map(shares_of, tasks)
        for rig in range(rigs):
            ups, downs = zip(*(next(results) for _ in range(calibrations)), strict=True)
            shares = [total(pair) for pair in zip(ups, downs, strict=True)]
            above, below = [*above, *ups], [*below, *downs]
            whole = total(shares)
            within += is_within(whole)
            clusters.append(shares)
            each = " ".join(str(one.trials - one.held) for one in shares)
            print(f"rig {rig + 1:2}: {_told(ups, downs)}; missed after each calibration: {each}", flush=True)
    whole = total([*above, *below])
    print(f"calibrated with loads on {sides} sides: {within} of {rigs} rigs within 92 .. 98 %; {_told(above, below)}")
    effect = design_effect(clusters)
    print(
        f"design effect {effect:.2f}: {whole.trials // rigs} trials of a rig tell as much as "
        f"{whole.trials / rigs / effect:.0f} that have nothing in common"
    )


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
