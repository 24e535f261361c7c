"""The zero-speed search of the paper (section 3.2.2, Fig. 5): a pure state machine.

    settled -> raise the current in small steps until the joint just moves (I_max) -> settled
            -> lower it until it just moves the other way (I_min) -> settled -> eqs (9), (10)

`advance(settings, state, reading)` takes one control cycle's reading and returns the next state and the
current to command, or None while the position servo has the joint.

What "just moved" means. The sensor sits on the motor side, before the backlash, and counts are finite. So a
motion is first only a *departure*: the sensor left its place by more than `onset_rad`. The current is then held.
If the sensor comes to rest again, the motor crossed its free play or the teeth gave way elastically, and the ramp
goes on from there. Only when it travels further than free play allows (`clear_travel_rad`, counted from the start of
the ramp) has the joint itself moved. The breakaway current is that of the last departure, back-dated to where it
began: halfway between the last step through which the sensor stood still and the step after it. (Motion begins far
slower than it goes on, and by the time `onset_rad` is reached the ramp has gone a few steps further.)
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from math import isfinite, isnan, nan
from typing import NamedTuple

from compensator.errors import ModelParameterError, NoEstimateError
from compensator.rest.breakaway_fit import BreakawayEstimate, estimate


class Phase(Enum):
    """Where the search is in Fig. 5."""

    SETTLE_BEFORE_RAISING = "settle before raising"
    RAISING = "raising the current"
    SETTLE_BEFORE_LOWERING = "settle before lowering"
    LOWERING = "lowering the current"
    SETTLE_AFTER_LOWERING = "settle after lowering"
    DONE = "done"
    FAILED = "failed"


class Reason(Enum):
    """Why a search ended without an estimate."""

    EXCURSION = "the joint went too far from the set point"
    CEILING = "the current reached its ceiling and the joint did not move"
    NOT_SETTLED = "the joint did not settle in the dead-band in time"
    MOVED_EARLY = "the joint kept moving before the current was changed"
    WRONG_WAY = "the joint moved against the change of current"
    TIME_OUT = "the joint kept creeping and neither stopped nor broke away in time"
    LOST_SAMPLE = "the position or the current was not measured"
    NO_BAND = "I_max is not above I_min"


@dataclass(frozen=True, slots=True)
class SearchSettings:
    """How the search is run. Cycles are control cycles.

    Attributes:
        dead_band_rad: position error within which the servo counts as arrived.
        still_rad: change of position that still counts as standing; just above one encoder count.
        onset_rad: change of position that counts as a departure; a few counts, above `still_rad`.
        free_play_rad: backlash, seen at the joint.
        excursion_rad: largest distance from the set point before the search gives up.
        current_step_a: size of one step of the ramp.
        step_cycles: length of one step.
        ceiling_a: largest magnitude of current commanded.
        settled_cycles: the joint is settled when still in the dead-band for more than this.
        settle_timeout_cycles: for each of the three waits.
        creep_timeout_cycles: for a departure that neither stops nor gets clear.
        retries: times that a joint which moves before its ramp is let settle again.
    """

    dead_band_rad: float
    still_rad: float
    onset_rad: float
    free_play_rad: float
    excursion_rad: float
    current_step_a: float
    step_cycles: int
    ceiling_a: float
    settled_cycles: int = 20
    settle_timeout_cycles: int = 2000
    creep_timeout_cycles: int = 400
    retries: int = 5

    def __post_init__(self) -> None:
        if not 0.0 < self.still_rad < self.onset_rad:
            raise ModelParameterError(f"still_rad is {self.still_rad}; allowed is 0 .. onset_rad, {self.onset_rad} rad")
        if self.excursion_rad <= self.clear_travel_rad + self.dead_band_rad:
            raise ModelParameterError(
                f"excursion_rad is {self.excursion_rad:.4g} rad; allowed is above "
                f"{self.clear_travel_rad + self.dead_band_rad:.4g} rad, or free play alone would end the search"
            )
        if self.current_step_a <= 0.0 or self.step_cycles < 1 or self.ceiling_a <= 0.0:
            raise ModelParameterError("current_step_a, step_cycles and ceiling_a must be above 0")

    @property
    def clear_travel_rad(self) -> float:
        """Travel that free play cannot explain: twice the gap, since the motor hits its far side at speed."""
        return 2.0 * self.free_play_rad + 2.0 * self.onset_rad


class SearchReading(NamedTuple):
    """What the search needs to see of one control cycle."""

    position_rad: float
    current_a: float  # measured, or eq. (3)
    command_a: float  # what the position servo asked for; the ramp starts from there


class SearchState(NamedTuple):
    """Everything the search remembers between cycles."""

    set_point_rad: float
    phase: Phase = Phase.SETTLE_BEFORE_RAISING
    phase_cycles: int = 0
    still_cycles: int = 0  # since the sensor last moved
    still_rad: float = nan  # where it has stood since
    start_rad: float = nan  # where this ramp began
    anchor_rad: float = nan  # where the sensor last came to rest in this ramp
    command_a: float = nan  # of the present step
    step_cycles: int = 0  # in the present step
    step_sum_a: float = 0.0  # of the current over the present step
    held_a: float = nan  # mean current of the last step through which the sensor stood still
    departure_a: float = nan  # NaN while the joint stands
    max_current_a: float = nan
    min_current_a: float = nan
    unsettled: int = 0  # times that the joint moved before its ramp
    reason: Reason | None = None

    @property
    def finished(self) -> bool:
        """True when the search ended, with or without an estimate."""
        return self.phase in (Phase.DONE, Phase.FAILED)

    def estimate(self) -> BreakawayEstimate:
        """Eqs (9), (10).

        Raises:
            NoEstimateError: the search has not ended, or ended for a named reason.
        """
        if self.phase is not Phase.DONE:
            why = self.reason.value if self.reason else f"it is still in phase '{self.phase.value}'"
            raise NoEstimateError(f"the zero-speed search has no estimate: {why}")
        return estimate(self.min_current_a, self.max_current_a)


Step = tuple[SearchState, float | None]
_RAMP_SIGN = {Phase.RAISING: 1.0, Phase.LOWERING: -1.0}
_BEFORE = {Phase.RAISING: Phase.SETTLE_BEFORE_RAISING, Phase.LOWERING: Phase.SETTLE_BEFORE_LOWERING}
_AFTER = {
    Phase.SETTLE_BEFORE_RAISING: Phase.RAISING,
    Phase.RAISING: Phase.SETTLE_BEFORE_LOWERING,
    Phase.SETTLE_BEFORE_LOWERING: Phase.LOWERING,
    Phase.LOWERING: Phase.SETTLE_AFTER_LOWERING,
    Phase.SETTLE_AFTER_LOWERING: Phase.DONE,
}


def begin(set_point_rad: float) -> SearchState:
    """A search round a set point; the position servo has the joint."""
    return SearchState(set_point_rad)


def advance(settings: SearchSettings, state: SearchState, reading: SearchReading) -> Step:
    """One control cycle.

    Returns:
        The next state, and the current to command [A], or None while the position servo has the joint.
    """
    if state.finished:
        return state, None
    if not (isfinite(reading.position_rad) and isfinite(reading.current_a) and isfinite(reading.command_a)):
        return _fail(state, Reason.LOST_SAMPLE)
    if abs(reading.position_rad - state.set_point_rad) > settings.excursion_rad:
        return _fail(state, Reason.EXCURSION)
    if state.phase in _RAMP_SIGN:
        return _ramp(settings, _track_stillness(settings, state, reading), reading)
    return _settle(settings, _track_stillness(settings, state, reading), reading)


def _fail(state: SearchState, reason: Reason) -> Step:
    return state._replace(phase=Phase.FAILED, reason=reason), None


def _track_stillness(settings: SearchSettings, state: SearchState, reading: SearchReading) -> SearchState:
    if abs(reading.position_rad - state.still_rad) <= settings.still_rad:
        return state._replace(still_cycles=state.still_cycles + 1, phase_cycles=state.phase_cycles + 1)
    return state._replace(still_cycles=0, still_rad=reading.position_rad, phase_cycles=state.phase_cycles + 1)


def _settle(settings: SearchSettings, state: SearchState, reading: SearchReading) -> Step:
    in_dead_band = abs(reading.position_rad - state.set_point_rad) <= settings.dead_band_rad
    if in_dead_band and state.still_cycles > settings.settled_cycles:
        following = _AFTER[state.phase]
        return _finish(state) if following is Phase.DONE else _begin_ramp(state, following, reading)
    if state.phase_cycles > settings.settle_timeout_cycles:
        return _fail(state, Reason.NOT_SETTLED)
    return state, None


def _finish(state: SearchState) -> Step:
    if not state.max_current_a > state.min_current_a:
        return _fail(state, Reason.NO_BAND)
    return state._replace(phase=Phase.DONE), None


def _begin_ramp(state: SearchState, phase: Phase, reading: SearchReading) -> Step:
    # the first step holds the servo's own current: a joint that leaves it was not settled
    state = state._replace(
        phase=phase,
        phase_cycles=0,
        start_rad=reading.position_rad,
        anchor_rad=reading.position_rad,
        command_a=reading.command_a,
        step_cycles=0,
        step_sum_a=0.0,
        held_a=nan,
        departure_a=nan,
    )
    return state, state.command_a


def _ramp(settings: SearchSettings, state: SearchState, reading: SearchReading) -> Step:
    follow: Callable[[SearchSettings, SearchState, SearchReading], Step]
    follow = _hold_step if isnan(state.departure_a) else _watch_departure
    return follow(settings, state, reading)


def _hold_step(settings: SearchSettings, state: SearchState, reading: SearchReading) -> Step:
    """The joint stands: watch for a departure, and take the next step when this one is over."""
    cycles = state.step_cycles + 1
    total_a = state.step_sum_a + reading.current_a
    if abs(reading.position_rad - state.anchor_rad) > settings.onset_rad:
        if isnan(state.held_a):
            return _settle_again(settings, state)
        # the step after the one that held: by the command's change, since eq. (3) is for steady speed
        step_a = _RAMP_SIGN[state.phase] * settings.current_step_a
        return state._replace(departure_a=state.held_a + step_a / 2, phase_cycles=0), state.command_a
    if cycles < settings.step_cycles:
        return state._replace(step_cycles=cycles, step_sum_a=total_a), state.command_a
    command_a = state.command_a + _RAMP_SIGN[state.phase] * settings.current_step_a
    if abs(command_a) > settings.ceiling_a:
        return _fail(state, Reason.CEILING)
    stands = abs(reading.position_rad - state.anchor_rad) <= settings.still_rad
    held_a = total_a / cycles if stands else state.held_a
    return state._replace(command_a=command_a, step_cycles=0, step_sum_a=0.0, held_a=held_a), command_a


def _settle_again(settings: SearchSettings, state: SearchState) -> Step:
    """The joint crept away under the servo's own current, too slowly to be seen: it had not settled."""
    if state.unsettled >= settings.retries:
        return _fail(state, Reason.MOVED_EARLY)
    before = _BEFORE[state.phase]
    return state._replace(phase=before, phase_cycles=0, still_cycles=0, unsettled=state.unsettled + 1), None


def _watch_departure(settings: SearchSettings, state: SearchState, reading: SearchReading) -> Step:
    """The sensor left its place: free play, or the joint?"""
    travel_rad = (reading.position_rad - state.start_rad) * _RAMP_SIGN[state.phase]
    if travel_rad > settings.clear_travel_rad:
        return _break_away(state)
    if travel_rad < -settings.clear_travel_rad:
        return _fail(state, Reason.WRONG_WAY)
    if state.still_cycles > settings.settled_cycles:
        # it stopped by itself: not the joint; go on from here
        state = state._replace(anchor_rad=reading.position_rad, departure_a=nan, step_cycles=0, step_sum_a=0.0)
        return state, state.command_a
    if state.phase_cycles > settings.creep_timeout_cycles:
        return _fail(state, Reason.TIME_OUT)
    return state, state.command_a


def _break_away(state: SearchState) -> Step:
    following = _AFTER[state.phase]
    if state.phase is Phase.RAISING:
        state = state._replace(max_current_a=state.departure_a)
    else:
        state = state._replace(min_current_a=state.departure_a)
    return state._replace(phase=following, phase_cycles=0, still_cycles=0), None
