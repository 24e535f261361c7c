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
from math import isfinite, nan
from typing import Any, NamedTuple

from compensator.errors import ModelParameterError
from compensator.rest.breakaway_fit import Breakaway
from compensator.rest.zero_speed_search import Reason, SearchReading

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


# at hand: Python 3.11 takes 0.1 us to find a member of an Enum
_RAMP, _SETTLING = Phase.RAMP, (Phase.SETTLE_BEFORE, Phase.SETTLE_AFTER)
_ENDED = (Phase.DONE, Phase.FAILED)


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


class Progress(NamedTuple):
    """How far the search has come: what changes a few times in a search."""

    set_point_rad: float
    phase: Phase = Phase.SETTLE_BEFORE
    sweep: int = 0  # ramps begun and ended: even ones up, odd ones down
    inside_a: float = nan  # a current under which the joint stood: the servo's
    ends_a: tuple[float, float] = (nan, nan)  # last breakaway down, up
    widen: float = 1.0  # of the margin
    retries: int = 0
    breakaways: tuple[Breakaway, ...] = ()
    reason: Reason | None = None

    @property
    def sign(self) -> float:
        """Direction of the present ramp."""
        return 1.0 if self.sweep % 2 == 0 else -1.0


class RestSearchState(NamedTuple):
    """Everything the search remembers between cycles; apart from `progress`, what changes with every cycle."""

    progress: Progress
    phase_cycles: int = 0
    still_cycles: int = 0  # since the sensor last moved
    still_rad: float = nan  # where it has stood since
    command_a: float = nan
    anchor_rad: float = nan  # where the sensor stood as the ramp began
    held_a: float = nan  # current of the last cycle in which it stood there
    held_cycles: int = 0  # since then

    @property
    def phase(self) -> Phase:
        """Where the search is."""
        return self.progress.phase

    @property
    def finished(self) -> bool:
        """True when the search ended, with or without an estimate."""
        return self.progress.phase in _ENDED


Step = tuple[RestSearchState, float | None]


def begin(set_point_rad: float) -> RestSearchState:
    """A search round a set point; the position servo has the joint."""
    return RestSearchState(Progress(set_point_rad))


def advance(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    """One control cycle.

    Returns:
        The next state, and the current to command [A], or None while the position servo has the joint.
    """
    progress, position_rad = state.progress, reading.position_rad
    phase = progress.phase
    if phase in _ENDED:
        return state, None
    if not (isfinite(position_rad) and isfinite(reading.current_a) and isfinite(reading.command_a)):
        return _fail(state, Reason.LOST_SAMPLE)
    if abs(position_rad - progress.set_point_rad) > settings.excursion_rad:
        return _fail(state, Reason.EXCURSION)
    state = _track(settings, state, position_rad)
    if phase in _SETTLING:
        return _settle(settings, state, reading)
    if phase is _RAMP:
        return _ramp(settings, state, reading)
    return _stop(settings, state, reading) if phase is Phase.STOP else _stand(settings, state, reading)


def _fail(state: RestSearchState, reason: Reason) -> Step:
    return _go_on(state, phase=Phase.FAILED, reason=reason), None


def _go_on(state: RestSearchState, **changes: Any) -> RestSearchState:
    """The state with something of its progress changed, in the first cycle of a phase."""
    return state._replace(progress=state.progress._replace(**changes), phase_cycles=0, still_cycles=0)


def _track(settings: RestSearchSettings, state: RestSearchState, position_rad: float) -> RestSearchState:
    progress, phase_cycles, still_cycles, still_rad, command_a, anchor_rad, held_a, held_cycles = state
    if abs(position_rad - still_rad) <= settings.still_rad:
        still_cycles += 1
    else:
        still_cycles, still_rad = 0, position_rad
    return RestSearchState(
        progress, phase_cycles + 1, still_cycles, still_rad, command_a, anchor_rad, held_a, held_cycles
    )


def _settle(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    progress = state.progress
    in_dead_band = abs(reading.position_rad - progress.set_point_rad) <= settings.dead_band_rad
    if in_dead_band and state.still_cycles > settings.settled_cycles:
        if progress.phase is Phase.SETTLE_AFTER:
            return _go_on(state, phase=Phase.DONE), None
        return _begin_stand(settings, state, reading, inside_a=reading.command_a)
    if state.phase_cycles > settings.settle_timeout_cycles:
        return _fail(state, Reason.NOT_SETTLED)
    return state, None


def _begin_stand(
    settings: RestSearchSettings, state: RestSearchState, reading: SearchReading, **changes: Any
) -> Step:  # fmt: skip
    """Jump to where the ramp begins. From a motion that is still under way, this stops it."""
    state = _go_on(state, phase=Phase.STAND, **changes)
    command_a = _start_a(settings, state.progress)
    return state._replace(anchor_rad=reading.position_rad, command_a=command_a), command_a


def _start_a(settings: RestSearchSettings, progress: Progress) -> float:
    low_a, high_a = progress.ends_a
    if progress.sweep < COARSE_SWEEPS:
        # a servo that overshot has left the joint at the edge of friction, where it creeps: stand farther inside
        farther_inside = progress.retries > 0 and progress.sweep > 0
        return (progress.inside_a + high_a) / 2.0 if farther_inside else progress.inside_a
    # what the fast ramp found lies too far out, by what it gained before motion was seen
    share = settings.coarse_share if progress.sweep < 2 * COARSE_SWEEPS else settings.margin_share
    margin_a = max(progress.widen * share * (high_a - low_a), settings.margin_a)
    middle_a = (low_a + high_a) / 2.0
    return max(high_a - margin_a, middle_a) if progress.sign > 0.0 else min(low_a + margin_a, middle_a)


def _stand(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    position_rad, sign = reading.position_rad, state.progress.sign
    if state.still_cycles >= settings.stand_cycles:
        state = _go_on(state, phase=Phase.RAMP)
        return state._replace(anchor_rad=position_rad, held_a=reading.current_a, held_cycles=0), state.command_a
    # it may still come from the other way; once it goes this way, the jump was too far
    behind_rad = min(sign * state.anchor_rad, sign * position_rad)
    state = state._replace(anchor_rad=sign * behind_rad)
    left = sign * position_rad - behind_rad >= settings.threshold_rad
    if left or state.phase_cycles > settings.stand_timeout_cycles:
        return _retry(settings, state)
    return state, state.command_a


def _retry(settings: RestSearchSettings, state: RestSearchState) -> Step:
    """The joint did not stand: the ramp would have begun too late, or the servo's own current moves the joint."""
    progress = state.progress
    if progress.retries >= settings.retries:
        return _fail(state, Reason.MOVED_EARLY)
    retries = progress.retries + 1
    if progress.sweep < COARSE_SWEEPS:
        return _go_on(state, phase=Phase.SETTLE_BEFORE, sweep=0, retries=retries), None
    # from the middle of the band friction stops it, whatever it is while sliding
    command_a = sum(progress.ends_a) / 2.0
    state = _go_on(state, phase=Phase.STOP, widen=2.0 * progress.widen, retries=retries)
    return state._replace(command_a=command_a), command_a


def _stop(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    if state.still_cycles >= settings.stand_cycles:
        return _begin_stand(settings, state, reading)
    if state.phase_cycles > settings.stand_timeout_cycles:
        return _fail(state, Reason.MOVED_EARLY)
    return state, state.command_a


def _ramp(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading) -> Step:
    progress, phase_cycles, still_cycles, still_rad, command_a, anchor_rad, held_a, held_cycles = state
    sign = progress.sign
    travel_rad = sign * (reading.position_rad - anchor_rad)
    rate_a_s = _rate_a_s(settings, progress.sweep)
    stands = abs(travel_rad) <= settings.still_rad
    held_a, held_cycles = (reading.current_a, 0) if stands else (held_a, held_cycles + 1)
    if travel_rad >= settings.threshold_rad:
        # by the command's growth since it stood: eq. (3) is for steady speed
        return _let_go(settings, state, reading, held_a + sign * rate_a_s * settings.period_s * held_cycles)
    if travel_rad <= -settings.threshold_rad:
        return _retry(settings, state) if progress.sweep >= COARSE_SWEEPS else _fail(state, Reason.WRONG_WAY)
    command_a += sign * rate_a_s * settings.period_s
    if abs(command_a) > settings.ceiling_a:
        return _fail(state, Reason.CEILING)
    # most cycles of a search end here; `_replace` takes three times as long
    state = RestSearchState(progress, phase_cycles, still_cycles, still_rad, command_a, anchor_rad, held_a, held_cycles)
    return state, command_a


def _rate_a_s(settings: RestSearchSettings, sweep: int) -> float:
    if sweep < COARSE_SWEEPS:
        return settings.coarse_a_s
    pair = (sweep - COARSE_SWEEPS) // 2
    return settings.fine_a_s[pair % len(settings.fine_a_s)]


def _let_go(settings: RestSearchSettings, state: RestSearchState, reading: SearchReading, current_a: float) -> Step:
    """The joint moves: note the current, and go for the other end of the band."""
    progress = state.progress
    sign, sweep, (low_a, high_a) = progress.sign, progress.sweep, progress.ends_a
    ends_a = (low_a, current_a) if sign > 0.0 else (current_a, high_a)
    breakaways = progress.breakaways
    if sweep >= COARSE_SWEEPS:
        breakaways = (*breakaways, Breakaway(sign, current_a, _rate_a_s(settings, sweep), state.anchor_rad))
    state = state._replace(progress=progress._replace(ends_a=ends_a, breakaways=breakaways, sweep=sweep + 1))
    if ends_a[1] <= ends_a[0]:
        return _fail(state, Reason.NO_BAND)
    if len(breakaways) >= 2 * settings.pairs:
        return _go_on(state, phase=Phase.SETTLE_AFTER), None
    return _begin_stand(settings, state, reading)
