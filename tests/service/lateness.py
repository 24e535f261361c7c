"""What `tests.service.rates` measures, and its table."""

from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tests.service.host_watch import Gaps, lost_cycles, own_lateness_s
from tests.service.timed_process import Cycles

ASKED_RATIO = 1.05


class Measured(Enum):
    """In this order, again and again."""

    WAITING = "only waiting, alone"
    ALONE = "trial, alone"
    WAITING_BESIDE = "only waiting, beside 50 readers ..."
    BESIDE = "trial, beside 50 readers ..."

    @property
    def waits(self) -> bool:
        """Whether it is the bare process."""
        return self in (Measured.WAITING, Measured.WAITING_BESIDE)

    @property
    def beside(self) -> bool:
        """Whether it is beside the readers."""
        return self in (Measured.BESIDE, Measured.WAITING_BESIDE)


WAITS = (Measured.WAITING, Measured.WAITING_BESIDE)


class Stretch(NamedTuple):
    """One trial, or as long a wait.

    Attributes:
        cycles: of the loop, or of the bare process.
        gaps: when the host had taken a processor away.
        served: answers given meanwhile.
    """

    cycles: Cycles
    gaps: Gaps
    served: int = 0

    @property
    def own_late_s(self) -> np.ndarray:
        """How late each cycle was by no fault of the host's [s]."""
        return own_lateness_s(*self.cycles, self.gaps)

    def p99_s(self, own: bool) -> float:
        """Of the lateness [s]; where `own`, of what of it was not the host's."""
        return float(np.percentile(self.own_late_s if own else self.cycles.late_s, 99))

    def lost(self, period_s: float) -> int:
        """Cycles that were lost, whoever was at fault."""
        return lost_cycles(self.cycles.late_s, period_s)

    def own_lost(self, period_s: float) -> int:
        """Those of them that were lost while no processor was away."""
        return lost_cycles(self.own_late_s, period_s)

    def in_words(self, period_s: float) -> str:
        """One line."""
        lost, own = self.lost(period_s), self.own_lost(period_s)
        away_ms = 1e3 * sum(end - begin for begin, end in self.gaps)
        whose = f"{lost} lost, of these {own} not the host's"
        host = f"the host took {away_ms:.0f} ms in {len(self.gaps)} gaps"
        p99_us, own_us = (1e6 * self.p99_s(one) for one in (False, True))
        late = f"p99 {p99_us:.0f} us, {own_us:.0f} without the host's"
        return f"{len(self.cycles.late_s)} cycles, {whose}; {late}; {host}"


def ratios(alone: Sequence[Stretch], beside: Sequence[Stretch], own: bool) -> list[float]:
    """p99 of each stretch beside the readers over the mean of those alone before and after it; `own`: see there."""
    around_s = [(before.p99_s(own) + after.p99_s(own)) / 2.0 for before, after in pairwise(alone)]
    return [one.p99_s(own) / alone_s for one, alone_s in zip(beside, around_s, strict=True)]


def report(found: Mapping[Measured, Sequence[Stretch]], period_s: float) -> Iterator[str]:
    """The table, and what was asked."""
    yield (
        f"{'at 1 kHz':35} | cycles | lost | not the host's | late [us]: median |  p99 | p99.9 |    max | "
        "host away [ms] | answers"
    )
    for what, stretches in found.items():
        late_us = 1e6 * np.concatenate([one.cycles.late_s for one in stretches])
        p50, p99, p999 = np.percentile(late_us, (50, 99, 99.9))
        lost, own = (sum(count(one, period_s) for one in stretches) for count in (Stretch.lost, Stretch.own_lost))
        served = sum(one.served for one in stretches)
        away_ms = 1e3 * sum(end - begin for one in stretches for begin, end in one.gaps)
        yield (
            f"{what.value:35} | {len(late_us):6} | {lost:4} | {own:14} | {p50:17.1f} | {p99:4.0f} | {p999:5.0f} "
            f"| {late_us.max():6.0f} | {away_ms:14.0f} | {served:7}"
        )
    own = sum(one.own_lost(period_s) for one in found[Measured.BESIDE])
    for name, kinds in (("trial", (Measured.ALONE, Measured.BESIDE)), ("only waiting", WAITS)):
        for whose, without_host in (("all lateness", False), ("without the host's", True)):
            each = ratios(*(found[kind] for kind in kinds), own=without_host)
            listed = ", ".join(f"{one:.2f}" for one in each)
            yield f"p99 beside / alone, {name}, {whose}: {listed}; median {np.median(each):.2f}"
    ratio = float(np.median(ratios(found[Measured.ALONE], found[Measured.BESIDE], own=True)))
    met = "" if ratio <= ASKED_RATIO and not own else "   NOT MET"
    asked = f"asked: no cycle lost, p99 at most x {ASKED_RATIO}"
    yield f"{asked}; measured, without the host's: {own} lost, x {ratio:.2f}{met}"
