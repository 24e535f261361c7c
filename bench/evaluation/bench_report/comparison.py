"""Is it worse than before? An exact permutation test per metric, with one false-alarm rate for all of them.

Under the hypothesis that nothing changed, the values of baseline and present are draws of one distribution, and every
way to share them out into two groups is equally likely (Fisher 1935, The Design of Experiments, section 21). The
p-value is the share of those ways whose difference of means is at least as large. It supposes nothing of the
distribution. Where lower is better, a metric is called worse where p is at most FAMILY_RATE divided by the number of
metrics (Bonferroni); where neither way is better, it is called changed where p of either way is at most half of that.
The chance that any metric is told although nothing changed is at most FAMILY_RATE. With the seeds of the baseline an
unchanged program gives the same numbers again, and the chance is nil.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from math import comb, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from bench.errors import BaselineError
from bench.evaluation.bench_report.campaign import METRICS, Metric, SeedValues
from compensator.lab.recordings.recording import FloatArray

FAMILY_RATE = 0.01
LEVEL = 0.95  # of the interval of the difference, which is there to show its size
ROUNDING = 1e-9  # of the largest value: differences of sums below it are none
Verdict = Literal["as before", "worse", "better", "changed", "failed"]


@dataclass(frozen=True, slots=True)
class Line:
    """One metric, before and now.

    Attributes:
        before, now: means over the seeds.
        change, low, high: difference of the means, and its interval (Welch); NaN where there is none.
        p_worse, p_better: of the permutation test.
        sentence: the verdict in words.
    """

    metric: Metric
    before: float
    now: float
    change: float
    low: float
    high: float
    p_worse: float
    p_better: float
    verdict: Verdict
    sentence: str


def compare(before: Sequence[SeedValues], now: Sequence[SeedValues], rate: float = FAMILY_RATE) -> list[Line]:
    """Every metric of the campaign.

    Args:
        before: the baseline.
        now: what was measured.
        rate: chance that any metric is called worse although nothing changed.

    Raises:
        BaselineError: too few seeds: no change, however large, could be told.
    """
    least = comb(len(before) + len(now), len(now))
    if least * rate < 2 * len(METRICS):
        raise BaselineError(
            f"{len(before)} seeds before and {len(now)} now are too few to tell any change of {len(METRICS)} metrics "
            f"at a false-alarm rate of {rate:g}; take more with --seeds"
        )
    return [_line(metric, before, now, rate / len(METRICS)) for metric in METRICS]


def _line(metric: Metric, before: Sequence[SeedValues], now: Sequence[SeedValues], level: float) -> Line:
    old = np.array([one.values[metric.name] for one in before])
    new = np.array([one.values[metric.name] for one in now if metric.name in one.values])
    if len(new) < len(now):
        reasons = "; ".join(failure for one in now for failure in one.failures)
        nothing = float("nan")
        mean = float(new.mean()) if len(new) else nothing
        sentence = f"{len(now) - len(new)} of {len(now)} seeds gave no value: {reasons}"
        return Line(metric, float(old.mean()), mean, *(nothing,) * 5, "failed", sentence)
    change = float(new.mean() - old.mean())
    low, high = _interval(old, new)
    p_worse, p_better = permutation_p(old, new), permutation_p(new, old)
    verdict = _verdict(metric, p_worse, p_better, level)
    p = min(p_worse, p_better) if metric.lower_is_better else min(1.0, 2.0 * min(p_worse, p_better))
    sentence = _sentence(verdict, change, low, high, p)
    return Line(metric, float(old.mean()), float(new.mean()), change, low, high, p_worse, p_better, verdict, sentence)


def _verdict(metric: Metric, p_worse: float, p_better: float, level: float) -> Verdict:
    if not metric.lower_is_better:  # either way: the rate is shared between them
        return "changed" if min(p_worse, p_better) <= level / 2 else "as before"
    return "worse" if p_worse <= level else "better" if p_better <= level else "as before"


def permutation_p(low: FloatArray, high: FloatArray) -> float:
    """The share of ways to share the values out in which the second group is at least as far above the first."""
    pooled = np.concatenate([low, high])
    sums = pooled[_ways(len(pooled), len(high))].sum(axis=1)
    return float(np.mean(sums >= high.sum() - ROUNDING * np.abs(pooled).max() * len(pooled)))


@lru_cache(maxsize=1)  # a report compares groups of one size, and to list the ways takes longer than their sums
def _ways(count: int, chosen: int) -> NDArray[np.int64]:
    """Every way to choose so many of a count, shape (ways, chosen)."""
    return np.array(list(combinations(range(count), chosen)))


def mean_interval(values: Sequence[float]) -> tuple[float, float, float]:
    """Mean, and its interval (Student)."""
    mean, count = float(np.mean(values)), len(values)
    half = float(stats.t.ppf(0.5 + LEVEL / 2, count - 1) * np.std(values, ddof=1) / sqrt(count))
    return mean, mean - half, mean + half


def _interval(old: FloatArray, new: FloatArray) -> tuple[float, float]:
    """Welch's interval of the difference of two means."""
    parts = old.var(ddof=1) / len(old), new.var(ddof=1) / len(new)
    change, total = float(new.mean() - old.mean()), float(sum(parts))
    if total == 0.0:
        return change, change
    freedom = total**2 / (parts[0] ** 2 / (len(old) - 1) + parts[1] ** 2 / (len(new) - 1))
    half = float(stats.t.ppf(0.5 + LEVEL / 2, freedom)) * sqrt(total)
    return change - half, change + half


def _sentence(verdict: Verdict, change: float, low: float, high: float, p: float) -> str:
    size = f"{change:+.3g} ({LEVEL:.0%} interval {low:+.3g} .. {high:+.3g}), p = {p:.2g}"
    if verdict == "better":
        return f"better by {size}; keep it with --update-baseline"
    if verdict == "changed":
        return f"changed by {size}; where that is meant, keep it with --update-baseline"
    return f"worse by {size}" if verdict == "worse" else f"as before: {size}"
