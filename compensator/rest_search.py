"""A zero-speed search in less time and with less motion than Fig. 5: a pure state machine.

    settled -> raise fast until the sensor leaves its place, lower fast until it leaves it the other way: a rough band
            -> again and again, up and down: jump to just inside of where it let go, ramp slowly until it leaves
            -> settled -> I_load, F_load and their intervals (`breakaway_fit`)

What makes it better than the flow chart. The position servo is not asked back in between: the jump to the other end of
the band stops the joint at once, within a few counts. The slow ramp runs over the last bit alone. Breakaways are many
and at two rates, so that what the ramp gains before motion is seen, and the friction's own scatter, show and are taken
out.

Within free play it is the motor alone that lets go, in both directions alike: I_load is then 0, which is what the teeth
carry. Where they carry a load, they stay in touch, and what lets go is the joint.

`advance(settings, state, reading)` takes one control cycle's reading and returns the next state and the current to
command, or None while the position servo has the joint.
"""

from dataclasses import dataclass
from enum import Enum
from math import isnan, nan
from typing import NamedTuple

from compensator.breakaway_fit import Breakaway
from compensator.errors import ModelParameterError
from compensator.zero_speed_search import Reason, SearchReading

COARSE_SWEEPS = 2


class Phase(Enum):
    """Where the search is."""

    SETTLE_BEFORE = "settle before the search"
    STOP = "stop before standing"
    STAND = "stand before a ramp"
    RAMP = "ramp"
    SETTLE_AFTER = "settle after the search"
    DONE = "done"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class RestSearchSettings:
    """How the search is run. Cycles are control cycles.

    Attributes:
        period_s: of the control loop.
        dead_band_rad: position error within which the servo counts as arrived.
        still_rad: change of position that still counts as standing; just above one encoder count.
        threshold_rad: distance from its place at which the joint is said to move; `motion_detection`.
        excursion_rad: largest distance from the set point before the search gives up.
        ceiling_a: largest magnitude of current commanded.
        coarse_a_s: rate of the first ramp either way.
        fine_a_s: rates of the others, in turn; two or more.
        pairs: slow ramps, up and down; 2 or more.
        margin_share, margin_a: a slow ramp begins that share of the band, or that current, before the last breakaway.
        coarse_share: the same, for the first slow ramp either way.
        stand_cycles: a ramp begins when the joint has stood for so long.
        settled_cycles: the joint is settled when still in the dead-band for more than this.
        settle_timeout_cycles: for each of the two waits for the servo.
        stand_timeout_cycles: for the joint to stand before a ramp.
        retries: times that a joint which does not stand is given a wider margin, or settled again.
    """

    period_s: float
    dead_band_rad: float
    still_rad: float
    threshold_rad: float
    excursion_rad: float
    ceiling_a: float
    coarse_a_s: float = 1.5
    fine_a_s: tuple[float, ...] = (0.6, 0.15)
    pairs: int = 4
    margin_share: float = 0.05
    margin_a: float = 0.012
    coarse_share: float = 0.12
    stand_cycles: int = 8
    settled_cycles: int = 20
    settle_timeout_cycles: int = 2000
    stand_timeout_cycles: int = 100
    retries: int = 5

    def __post_init__(self) -> None:
        if not 0.0 < self.still_rad < self.threshold_rad < self.excursion_rad:
            raise ModelParameterError(
                f"still_rad, threshold_rad, excursion_rad are {self.still_rad:.4g}, {self.threshold_rad:.4g}, "
                f"{self.excursion_rad:.4g} rad; allowed is above 0 and rising"
            )
        rates = (*self.fine_a_s, self.coarse_a_s)
        if len(set(self.fine_a_s)) < 2 or min(rates) <= 0.0 or self.pairs < 2:
            raise ModelParameterError("two different fine_a_s, rates above 0 and 2 pairs or more are needed")
        if min(self.period_s, self.ceiling_a, self.margin_a) <= 0.0 or self.margin_share < 0.0:
            raise ModelParameterError("period_s, ceiling_a and margin_a must be above 0, margin_share 0 or more")


class RestSearchState(NamedTuple):
    """Everything the search remembers between cycles."""

    set_point_rad: float
    phase: Phase = Phase.SETTLE_BEFORE
    phase_cycles: int = 0
    cycles: int = 0  # since the search began
    still_cycles: int = 0  # since the sensor last moved
    still_rad: float = nan  # where it has stood since
    last_rad: float = nan
    travel_rad: float = 0.0  # all motion, either way
    sweep: int = 0  # ramps begun and ended: even ones up, odd ones down
    inside_a: float = nan  # a current under which the joint stood: the servo's
    command_a: float = nan
    anchor_rad: float = nan  # where the sensor stood as the ramp began
    held_a: float = nan  # current of the last cycle in which it stood there
    held_cycles: int = 0  # since then
    ends_a: tuple[float, float] = (nan, nan)  # last breakaway down, up
    widen: float = 1.0  # of the margin
    retries: int = 0
    breakaways: tuple[Breakaway, ...] = ()
    reason: Reason | None = None

    @property
    def finished(self) -> bool:
        """True when the search ended, with or without an estimate."""
        return self.phase in (Phase.DONE, Phase.FAILED)

    @property
    def sign(self) -> float:
        """Direction of the present ramp."""
        return 1.0 if self.sweep % 2 == 0 else -1.0


Step = tuple[RestSearchState, float | None]


def begin(set_point_rad: float) -> RestSearchState:
    """A search round a set point; the position servo has the joint."""
    return RestSearchState(set_point_rad)


def advance(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    """One control cycle.

    Returns:
        The next state, and the current to command [A], or None while the position servo has the joint.
    """
    if state.finished:
        return state, None
    if isnan(reading.position_rad) or isnan(reading.current_a):
        return _fail(state, Reason.LOST_SAMPLE)
    state = _track(settings, state, reading)
    if state.phase in (Phase.SETTLE_BEFORE, Phase.SETTLE_AFTER):
        return _settle(settings, state, reading)
    if abs(reading.position_rad - state.set_point_rad) > settings.excursion_rad:
        return _fail(state, Reason.EXCURSION)
    if state.phase is Phase.STOP:
        return _stop(settings, state)
    return _stand(settings, state, reading) if state.phase is Phase.STAND else _ramp(settings, state, reading)


def _fail(state: RestSearchState, reason: Reason) -> Step:
    return state._replace(phase=Phase.FAILED, reason=reason), None


def _track(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> RestSearchState:
    position_rad = reading.position_rad
    moved_rad = 0.0 if isnan(state.last_rad) else abs(position_rad - state.last_rad)
    state = state._replace(
        cycles=state.cycles + 1,
        phase_cycles=state.phase_cycles + 1,
        last_rad=position_rad,
        travel_rad=state.travel_rad + moved_rad,
    )
    if abs(position_rad - state.still_rad) <= settings.still_rad:
        return state._replace(still_cycles=state.still_cycles + 1)
    return state._replace(still_cycles=0, still_rad=position_rad)


def _settle(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    in_dead_band = abs(reading.position_rad - state.set_point_rad) <= settings.dead_band_rad
    if in_dead_band and state.still_cycles > settings.settled_cycles:
        if state.phase is Phase.SETTLE_AFTER:
            return state._replace(phase=Phase.DONE), None
        state = state._replace(inside_a=reading.command_a, command_a=reading.command_a)
        return _begin_stand(settings, state)
    if state.phase_cycles > settings.settle_timeout_cycles:
        return _fail(state, Reason.NOT_SETTLED)
    return state, None


def _begin_stand(settings: RestSearchSettings, state: RestSearchState) -> Step:
    """Jump to where the ramp begins. From a motion that is still under way, this stops it."""
    state = state._replace(
        phase=Phase.STAND,
        phase_cycles=0,
        still_cycles=0,
        anchor_rad=state.last_rad,
        command_a=_start_a(settings, state),
    )
    return state, state.command_a


def _start_a(settings: RestSearchSettings, state: RestSearchState) -> float:
    low_a, high_a = state.ends_a
    if state.sweep < COARSE_SWEEPS:
        return state.inside_a
    # what the fast ramp found lies too far out, by what it gained before motion was seen
    share = settings.coarse_share if state.sweep < 2 * COARSE_SWEEPS else settings.margin_share
    margin_a = max(state.widen * share * (high_a - low_a), settings.margin_a)
    middle_a = (low_a + high_a) / 2.0
    return max(high_a - margin_a, middle_a) if state.sign > 0.0 else min(low_a + margin_a, middle_a)


def _stand(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    if state.still_cycles >= settings.stand_cycles:
        state = state._replace(
            phase=Phase.RAMP, phase_cycles=0, anchor_rad=reading.position_rad, held_a=reading.current_a, held_cycles=0
        )
        return state, state.command_a
    # it may still come from the other way; once it goes this way, the jump was too far
    behind_rad = min(state.sign * state.anchor_rad, state.sign * reading.position_rad)
    state = state._replace(anchor_rad=state.sign * behind_rad)
    left = state.sign * reading.position_rad - behind_rad >= settings.threshold_rad
    if left or state.phase_cycles > settings.stand_timeout_cycles:
        return _retry(settings, state)
    return state, state.command_a


def _retry(settings: RestSearchSettings, state: RestSearchState) -> Step:
    """The joint did not stand: the ramp would have begun too late, or the servo's own current moves the joint."""
    if state.retries >= settings.retries:
        return _fail(state, Reason.MOVED_EARLY)
    state = state._replace(retries=state.retries + 1, phase_cycles=0, still_cycles=0)
    if state.sweep < COARSE_SWEEPS:
        return state._replace(phase=Phase.SETTLE_BEFORE, sweep=0), None
    # from the middle of the band friction stops it, whatever it is while sliding
    state = state._replace(phase=Phase.STOP, widen=2.0 * state.widen, command_a=sum(state.ends_a) / 2.0)
    return state, state.command_a


def _stop(settings: RestSearchSettings, state: RestSearchState) -> Step:
    if state.still_cycles >= settings.stand_cycles:
        return _begin_stand(settings, state)
    if state.phase_cycles > settings.stand_timeout_cycles:
        return _fail(state, Reason.MOVED_EARLY)
    return state, state.command_a


def _ramp(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    travel_rad = state.sign * (reading.position_rad - state.anchor_rad)
    rate_a_s = _rate_a_s(settings, state)
    if abs(travel_rad) <= settings.still_rad:
        state = state._replace(held_a=reading.current_a, held_cycles=0)
    else:
        state = state._replace(held_cycles=state.held_cycles + 1)
    if travel_rad >= settings.threshold_rad:
        return _let_go(settings, state, rate_a_s)
    if travel_rad <= -settings.threshold_rad:
        return _retry(settings, state) if state.sweep >= COARSE_SWEEPS else _fail(state, Reason.WRONG_WAY)
    command_a = state.command_a + state.sign * rate_a_s * settings.period_s
    if abs(command_a) > settings.ceiling_a:
        return _fail(state, Reason.CEILING)
    return state._replace(command_a=command_a), command_a


def _rate_a_s(settings: RestSearchSettings, state: RestSearchState) -> float:
    if state.sweep < COARSE_SWEEPS:
        return settings.coarse_a_s
    pair = (state.sweep - COARSE_SWEEPS) // 2
    return settings.fine_a_s[pair % len(settings.fine_a_s)]


def _let_go(settings: RestSearchSettings, state: RestSearchState, rate_a_s: float) -> Step:
    """The joint moves: note the current, and go for the other end of the band."""
    # by the command's growth since it stood: eq. (3) is for steady speed
    current_a = state.held_a + state.sign * rate_a_s * settings.period_s * state.held_cycles
    low_a, high_a = state.ends_a
    ends_a = (low_a, current_a) if state.sign > 0.0 else (current_a, high_a)
    fine = state.sweep >= COARSE_SWEEPS
    breakaways = (*state.breakaways, Breakaway(state.sign, current_a, rate_a_s)) if fine else state.breakaways
    state = state._replace(ends_a=ends_a, breakaways=breakaways, sweep=state.sweep + 1)
    if ends_a[1] <= ends_a[0]:
        return _fail(state, Reason.NO_BAND)
    if len(breakaways) >= 2 * settings.pairs:
        return state._replace(phase=Phase.SETTLE_AFTER, phase_cycles=0, still_cycles=0), None
    return _begin_stand(settings, state)
