"""The zero-speed search on the bench: the flow chart of the paper, or the improved one, as the configuration says."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import partial
from math import ceil
from typing import Any, Generic, Protocol, TypeVar

from bench.config.configuration import BenchConfiguration
from bench.config.rig import resolution_rad
from bench.errors import ConfigurationError
from compensator.rest import rest_search, zero_speed_search
from compensator.rest.breakaway_fit import Breakaway
from compensator.rest.motion_detection import threshold_counts
from compensator.rest.rest_search import RestSearchSettings, RestSearchState
from compensator.rest.zero_speed_search import SearchReading, SearchSettings, SearchState

STILL_COUNTS = 1.5


@dataclass(frozen=True, slots=True)
class Found:
    """How a search ended.

    Attributes:
        failure: why there is no estimate; "" where there is.
        breakaways: of the paper's search one each way, at the mean rate of its staircase; none where it failed.
        seconds, travel_rad: time and motion that it took.
    """

    failure: str
    breakaways: tuple[Breakaway, ...] = ()
    seconds: float = 0.0
    travel_rad: float = 0.0


class _State(Protocol):
    """Of either method: where it is, and whether it ended, with or without an estimate."""

    @property
    def finished(self) -> bool: ...

    @property
    def phase(self) -> Enum: ...


StateT = TypeVar("StateT", bound=_State)


class Search(Generic[StateT]):
    """One search, cycle by cycle.

    Attributes:
        finished: True when it ended, with or without an estimate.
    """

    def __init__(
        self,
        state: StateT,
        advance: Callable[[StateT, SearchReading], tuple[StateT, float | None]],
        found: Callable[[StateT], Found],
    ) -> None:
        self._state, self._advance, self._found = state, advance, found
        self.finished, self.phase = state.finished, str(state.phase.value)

    def advance(self, reading: SearchReading) -> float | None:
        """One control cycle: the current to command [A], or None while the position servo has the joint."""
        before = self._state
        self._state, current_a = self._advance(before, reading)
        if self._state.phase is not before.phase:
            self.finished, self.phase = self._state.finished, self._state.phase.value
        return current_a

    def found(self) -> Found:
        """How it ended."""
        return self._found(self._state)


def begin_search(configuration: BenchConfiguration, set_point_rad: float) -> Search[Any]:
    """A search by the method of the configuration: Fig. 5, or several quick breakaways at two rates.

    Raises:
        ConfigurationError: the rig leaves out encoder counts, gear ratio or, for the paper's, backlash.
    """
    if configuration.search.method != "paper":
        improved = partial(rest_search.advance, improved_settings(configuration))
        return Search(rest_search.begin(set_point_rad), improved, _found)
    advance = partial(zero_speed_search.advance, paper_settings(configuration))
    rate_a_s = configuration.search.current_step_a / configuration.search.step_s
    return Search(zero_speed_search.begin(set_point_rad), advance, partial(_found_by_paper, rate_a_s))


def _found_by_paper(rate_a_s: float, state: SearchState) -> Found:
    if state.phase is not zero_speed_search.Phase.DONE:
        return Found(state.reason.value if state.reason else state.phase.value)
    ends = ((1.0, state.max_current_a), (-1.0, state.min_current_a))
    return Found("", tuple(Breakaway(sign, current_a, rate_a_s) for sign, current_a in ends))


def _found(state: RestSearchState) -> Found:
    progress = state.progress
    if progress.phase is not rest_search.Phase.DONE:
        return Found(progress.reason.value if progress.reason else progress.phase.value)
    return Found("", progress.breakaways)


def paper_settings(configuration: BenchConfiguration) -> SearchSettings:
    """The flow chart in control cycles and encoder counts.

    Raises:
        ConfigurationError: the rig leaves out counts, ratio or backlash.
    """
    search, period_s = configuration.search, configuration.control.period_s
    free_play_rad = configuration.rig.gear.backlash_rad if search.free_play_rad is None else search.free_play_rad
    if free_play_rad is None:
        raise ConfigurationError(
            f"rig '{configuration.rig.name}': gear.backlash_rad [rad] is needed to tell free play from motion; add it "
            "to the rig, or give search.free_play_rad"
        )
    return SearchSettings(
        dead_band_rad=configuration.servo.dead_band_rad,
        still_rad=STILL_COUNTS * resolution_rad(configuration.rig),
        onset_rad=search.onset_counts * resolution_rad(configuration.rig),
        free_play_rad=free_play_rad,
        excursion_rad=search.excursion_rad,
        current_step_a=search.current_step_a,
        step_cycles=max(1, round(search.step_s / period_s)),
        ceiling_a=search.ceiling_a,
        settled_cycles=configuration.motion.settled_cycles,
        settle_timeout_cycles=ceil(configuration.motion.settle_timeout_s / period_s),
        creep_timeout_cycles=ceil(search.creep_timeout_s / period_s),
    )


def improved_settings(configuration: BenchConfiguration) -> RestSearchSettings:
    """The improved search in control cycles and encoder counts.

    Raises:
        ConfigurationError: the rig leaves out counts or ratio.
    """
    search, period_s = configuration.search, configuration.control.period_s
    count_rad = resolution_rad(configuration.rig)
    counts = threshold_counts(search.noise_counts, search.false_alarms_per_hour, period_s)
    return RestSearchSettings(
        period_s=period_s,
        dead_band_rad=configuration.servo.dead_band_rad,
        still_rad=STILL_COUNTS * count_rad,
        threshold_rad=counts * count_rad,
        excursion_rad=search.excursion_rad,
        ceiling_a=search.ceiling_a,
        coarse_a_s=search.coarse_rate_a_s,
        fine_a_s=search.fine_rates_a_s,
        pairs=search.pairs,
        settled_cycles=configuration.motion.settled_cycles,
        settle_timeout_cycles=ceil(configuration.motion.settle_timeout_s / period_s),
        stand_cycles=max(2, ceil(search.stand_s / period_s)),
        stand_timeout_cycles=ceil(search.stand_timeout_s / period_s),
    )
