"""How much room on the disk a trial takes, and whether there is as much."""

from dataclasses import dataclass
from math import ceil
from typing import Self

from bench.store.errors import StoreFullError
from bench.store.tables.samples import SAMPLE_BYTES

OVERHEAD = 1.3  # overview, pages, indexes and the write-ahead log, beside the samples


@dataclass(frozen=True, slots=True)
class SpaceNeed:
    """What one trial takes.

    Attributes:
        reserve_bytes: what has to stay free.
        told: how it was reckoned, in words.
    """

    trial_bytes: int
    reserve_bytes: int
    told: str

    @classmethod
    def of(cls, trial_s: float, period_s: float, reserve_mb: float, channels: int) -> Self:
        """The need of a trial of an estimated length [s], sampled every `period_s` [s]."""
        size = ceil(trial_s / period_s * channels * SAMPLE_BYTES * OVERHEAD)
        told = f"{trial_s:.0f} s at {1 / period_s:.0f} rows/s of {channels} channels"
        return cls(size, ceil(reserve_mb * 1e6), told)

    def check(self, free_bytes: int | None, trials: int, where: str) -> None:
        """Refuse where that many trials do not fit; a server's disk is not known.

        Raises:
            StoreFullError: they do not.
        """
        needed = trials * self.trial_bytes + self.reserve_bytes
        if free_bytes is None or free_bytes >= needed:
            return
        each = "one trial" if trials == 1 else f"{trials} trials"
        raise StoreFullError(
            f"store '{where}': {free_bytes / 1e6:.0f} MB are free on its disk; {each} ({self.told} each) and the "
            f"reserve of {self.reserve_bytes / 1e6:.0f} MB need {needed / 1e6:.0f} MB. Free some space, or remove old "
            "experiments: friction-bench store prune"
        )
