"""The table: asked beside measured, on the rig of the paper and on the rigs drawn round it."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import inf, isnan, nan

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.evaluation.figures.coverage import Share, median_interval, reached_by_most
from bench.evaluation.figures.rows import ASKED, BESIDE, Asked, median
from bench.evaluation.figures.trials import SeedResults
from bench.evaluation.figures.wall import ASKED_AT_A_WALL, BESIDE_A_WALL

ALL = (*ASKED, *ASKED_AT_A_WALL, *BESIDE, *BESIDE_A_WALL)
COLUMNS = (
    "quantity", "paper", "asked", "measured#", "95 %", "9 of 10#", "worst seed#", "reached", "rigs: mean#",
    "rigs: median#", "rigs: 95 %", "rigs: 9 of 10#", "rigs: worst#", "rigs: reached#",
)  # fmt: skip


@dataclass(frozen=True)
class FigureRow:
    """One line.

    Attributes:
        name, unit, paper, asked, note: in words.
        measured, worst_seed: over the seeds of the rig of the paper.
        reached: None where nothing was asked.
        rigs_mean, rigs_median, rigs_worst, rigs_reached: over the drawn rigs; the share of them that reach it.
        seeds, rigs: how many gave a number.
        sure, rigs_sure: "low .. high (of so many)", the 95 % interval of a share of all trials, or of a median over
            seeds or rigs; "-" otherwise.
        most_seeds, most_rigs: what nine of ten of them reach.
    """

    name: str
    unit: str
    paper: str
    asked: str
    note: str
    measured: float
    worst_seed: float
    reached: bool | None
    rigs_mean: float
    rigs_median: float
    rigs_worst: float
    rigs_reached: float
    seeds: int
    rigs: int
    sure: str = "-"
    rigs_sure: str = "-"
    most_seeds: float = nan
    most_rigs: float = nan

    def cells(self) -> tuple[object, ...]:
        """One row, in the order of `COLUMNS`."""
        name = f"{self.name} [{self.unit}]" if self.unit else self.name
        reached = "-" if self.reached is None else ("yes" if self.reached else "no")
        rigs_reached = "-" if isnan(self.rigs_reached) else f"{self.rigs_reached:.0%}"
        return (
            name, self.paper, self.asked, self.measured, self.sure, self.most_seeds, self.worst_seed, reached,
            self.rigs_mean, self.rigs_median, self.rigs_sure, self.most_rigs, self.rigs_worst, rigs_reached,
        )  # fmt: skip

    def to_json(self) -> dict[str, object]:
        """By name."""
        return asdict(self)


def figures_table(
    own: BenchConfiguration,
    seeds: Sequence[SeedResults],
    drawn: Sequence[BenchConfiguration],
    rigs: Sequence[SeedResults],
) -> list[FigureRow]:
    """Every figure.

    Args:
        own: the rig of the paper.
        seeds: what its seeds gave.
        drawn: the rigs drawn round it.
        rigs: what each of them gave.
    """
    return [_row(asked, own, seeds, list(zip(drawn, rigs, strict=True))) for asked in ALL]


def _row(
    asked: Asked,
    own: BenchConfiguration,
    seeds: Sequence[SeedResults],
    rigs: Sequence[tuple[BenchConfiguration, SeedResults]],
) -> FigureRow:
    numbers = [number for seed in seeds for number in asked.numbers(seed, own)]
    of_rigs = [asked.whole(asked.numbers(found, bench)) for bench, found in rigs]
    drawn = [number for number in of_rigs if not isnan(number)]
    measured = asked.whole(numbers)
    judged = not isnan(asked.high)
    reached = [_reaches(asked, number, asked.drawn_high) for number in drawn]
    return FigureRow(
        asked.name,
        asked.unit,
        asked.paper,
        _allowed(asked),
        asked.note,
        measured,
        _worst(asked, numbers),
        _reaches(asked, measured) if judged else None,
        float(np.mean(drawn)) if drawn else nan,
        float(np.median(drawn)) if drawn else nan,
        _worst(asked, drawn),
        sum(reached) / len(reached) if reached and judged else nan,
        len(numbers),
        len(drawn),
        _sure(asked, [(seed, own) for seed in seeds], numbers),
        _sure(asked, [(found, bench) for bench, found in rigs], drawn),
        reached_by_most(numbers, asked.low > 0.0),
        reached_by_most(drawn, asked.low > 0.0),
    )


def _sure(asked: Asked, found: Sequence[tuple[SeedResults, BenchConfiguration]], numbers: Sequence[float]) -> str:
    """What the share of all trials together may be, or the median of the numbers."""
    if asked.share is not None:
        shares = [asked.share(*one) for one in found]
        whole = Share(sum(one.held for one in shares), sum(one.trials for one in shares))
        low, high = whole.interval()
        return f"{100.0 * low:.1f} .. {100.0 * high:.1f} ({whole.trials})" if whole.trials else "-"
    low, high = median_interval(numbers)
    return f"{low:.3g} .. {high:.3g} ({len(numbers)})" if asked.whole is median and not isnan(low) else "-"


def _reaches(asked: Asked, number: float, high: float | None = None) -> bool:
    return asked.low <= number <= (asked.high if high is None else high)


def _allowed(asked: Asked) -> str:
    if isnan(asked.high):
        return "-"
    if asked.low > 0.0:
        return f"at least {asked.low:g}" if asked.high == inf else f"{asked.low:g} .. {asked.high:g}"
    drawn = "" if asked.drawn_high is None else f"; drawn rigs {asked.drawn_high:.4g}"
    return f"at most {asked.high:.4g}{drawn}"


def _worst(asked: Asked, numbers: Sequence[float]) -> float:
    if not numbers:
        return nan
    return min(numbers) if asked.low > 0.0 else max(numbers)
