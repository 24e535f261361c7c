"""Whatever samples arrive, a search has a result only with all of its conditions, and otherwise a named reason."""

from dataclasses import replace
from math import inf, isfinite, nan

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from compensator.errors import NoEstimateError
from compensator.rest import rest_search, zero_speed_search
from compensator.rest.zero_speed_search import Reason, SearchReading
from tests.compensator import test_rest_search as improved
from tests.compensator import test_zero_speed_search as flow_chart

SET_POINT_RAD = 1.5
COUNT_RAD = 1e-4
QUICK = replace(improved.SETTINGS, pairs=2, settle_timeout_cycles=200)
PLAIN = flow_chart.SETTINGS
MOST_CYCLES = 6000
WORTHLESS = (nan, inf, -inf)

worthless = st.tuples(st.just("worthless"), st.sampled_from(("position_rad", "current_a", "command_a")))
moved = st.tuples(st.sampled_from(("glitch", "jump")), st.integers(-3000, 3000))  # counts, for a cycle or for good
repeated = st.tuples(st.just("repeated"), st.integers(1, 60))  # cycles in which the old sample comes again
accidents = st.dictionaries(st.integers(0, 600), st.one_of(worthless, moved, repeated), max_size=4)
anything = st.lists(st.tuples(st.integers(-60, 60), st.integers(1, 120)), max_size=40)  # counts off, for how long


class Accidents:
    """What becomes of the readings of a joint."""

    def __init__(self, planned):
        self.planned, self.offset_rad, self.old, self.repeats = planned, 0.0, None, 0

    def alter(self, cycle, reading):
        kind, what = self.planned.get(cycle, (None, None))
        if kind == "repeated":
            self.repeats = what
        if kind == "jump":
            self.offset_rad += what * COUNT_RAD
        glitch_rad = what * COUNT_RAD if kind == "glitch" else 0.0
        reading = reading._replace(position_rad=reading.position_rad + self.offset_rad + glitch_rad)
        if kind == "worthless":
            reading = reading._replace(**{what: WORTHLESS[cycle % 3]})
        if self.repeats > 0 and self.old is not None:
            self.repeats -= 1
            return self.old
        self.old = reading
        return reading


def play(machine, limits, joint, alter):
    """Every (phase before, reading, state after) of a search."""
    state, command_a, trace = machine.begin(SET_POINT_RAD), joint.held_a, []
    for cycle in range(MOST_CYCLES):
        position_rad = joint.position_rad if hasattr(joint, "position_rad") else joint.motor_rad
        counted_rad = np.floor(position_rad / COUNT_RAD) * COUNT_RAD
        reading = alter(cycle, SearchReading(float(counted_rad), command_a, joint.held_a))
        before = state.phase
        state, ramp_a = machine.advance(limits, state, reading)
        trace.append((before, reading, state))
        if state.finished:
            return trace
        assert ramp_a is None or (isfinite(ramp_a) and abs(ramp_a) <= limits.ceiling_a)
        command_a = joint.held_a if ramp_a is None else ramp_a
        joint.servo() if ramp_a is None else joint.push(command_a)
    raise AssertionError(f"no end after {MOST_CYCLES} cycles, in {state.phase}")


def check_readings(trace, limits):
    """What holds of the readings behind any result, whichever way it was found."""
    positions_rad = np.array([reading.position_rad for _, reading, _ in trace])
    assert np.all(np.isfinite([reading for _, reading, _ in trace]))
    assert np.all(np.abs(positions_rad - SET_POINT_RAD) <= limits.excursion_rad)
    # it rested at the set point when it ended
    last_rad = positions_rad[-limits.settled_cycles :]
    assert np.all(np.abs(last_rad[-1:] - SET_POINT_RAD) <= limits.dead_band_rad)
    assert np.ptp(last_rad) <= 2.0 * limits.still_rad


def check_improved(trace):
    """Each breakaway: the joint stood, then went its way by the threshold, within the ceiling."""
    check_readings(trace, QUICK)
    breakaways = trace[-1][2].progress.breakaways
    assert len(breakaways) == 2 * QUICK.pairs
    for rate in QUICK.fine_a_s:
        assert sum(one.direction for one in breakaways if one.rate_a_s == rate) == 0.0
    positions_rad = [reading.position_rad for _, reading, _ in trace]
    seen, begun = 0, None
    for cycle, (before, _, after) in enumerate(trace):
        if before is rest_search.Phase.STAND and after.phase is rest_search.Phase.RAMP:
            begun = cycle
        if len(after.progress.breakaways) > seen:
            one = after.progress.breakaways[seen]
            seen += 1
            assert isfinite(one.current_a)
            assert abs(one.current_a) <= QUICK.ceiling_a + QUICK.coarse_a_s * QUICK.period_s
            stood_rad = positions_rad[begun - QUICK.stand_cycles + 1 : begun + 1]
            assert np.ptp(stood_rad) <= 2.0 * QUICK.still_rad
            assert one.direction * (positions_rad[cycle] - positions_rad[begun]) >= QUICK.threshold_rad - 1e-12
    low_a, high_a = trace[-1][2].progress.ends_a
    assert low_a < high_a


def check_flow_chart(trace):
    check_readings(trace, PLAIN)
    final = trace[-1][2]
    assert -PLAIN.ceiling_a <= final.min_current_a < final.max_current_a <= PLAIN.ceiling_a
    positions_rad = np.array([reading.position_rad for _, reading, _ in trace])
    for phase, sign in ((zero_speed_search.Phase.RAISING, 1.0), (zero_speed_search.Phase.LOWERING, -1.0)):
        ramp = [cycle for cycle, (before, _, _) in enumerate(trace) if before is phase]
        assert np.max(sign * (positions_rad[ramp] - positions_rad[ramp[0]])) > PLAIN.clear_travel_rad - PLAIN.onset_rad


def check(trace, machine):
    state = trace[-1][2]
    if machine is rest_search:
        if state.phase is rest_search.Phase.DONE:
            check_improved(trace)
        else:
            assert isinstance(state.progress.reason, Reason)
    elif state.phase is zero_speed_search.Phase.DONE:
        check_flow_chart(trace)
    else:
        assert isinstance(state.reason, Reason)
        with pytest.raises(NoEstimateError, match=state.reason.value):
            state.estimate()


SEARCHES = [(rest_search, QUICK, improved.KnownJoint), (zero_speed_search, PLAIN, flow_chart.KnownJoint)]


@pytest.mark.parametrize(("machine", "limits", "joint"), SEARCHES, ids=["improved", "flow chart"])
@settings(max_examples=60, derandomize=True)
@given(planned=accidents, load_a=st.sampled_from((-0.3, 0.0, 0.5)), friction_a=st.sampled_from((0.1, 0.4)))
@example(planned={}, load_a=0.5, friction_a=0.4)
def test_accidents_leave_a_result_with_all_of_its_conditions_or_a_reason(
    machine, limits, joint, planned, load_a, friction_a
):
    trace = play(machine, limits, joint(load_a, friction_a), Accidents(planned).alter)
    check(trace, machine)
    assert planned or trace[-1][2].phase.value == "done"  # the joint itself is one that can be searched


@pytest.mark.parametrize(("machine", "limits", "joint"), SEARCHES, ids=["improved", "flow chart"])
@settings(max_examples=60, derandomize=True)
@given(shown=anything, first=st.integers(0, 120))
def test_a_sensor_that_shows_anything_at_all(machine, limits, joint, shown, first):
    places = [place for place, cycles in shown for _ in range(cycles)]

    def alter(cycle, reading):
        at = cycle - first
        return (
            reading
            if not 0 <= at < len(places)
            else reading._replace(position_rad=SET_POINT_RAD + places[at] * COUNT_RAD)
        )

    check(play(machine, limits, joint(), alter), machine)


@pytest.mark.parametrize(("machine", "limits", "joint"), SEARCHES, ids=["improved", "flow chart"])
@pytest.mark.parametrize("name", ["position_rad", "current_a", "command_a"])
@pytest.mark.parametrize("value", WORTHLESS)
def test_a_worthless_sample_in_any_phase_ends_the_search_at_once(machine, limits, joint, name, value):
    whole = play(machine, limits, joint(), lambda _cycle, reading: reading)
    phases = [before for before, _, _ in whole]
    for phase in set(phases):
        at = phases.index(phase) + 1

        def alter(cycle, reading, at=at):
            return reading._replace(**{name: value}) if cycle == at else reading

        trace = play(machine, limits, joint(), alter)
        assert len(trace) == at + 1
        final = trace[-1][2]
        assert (final.progress if machine is rest_search else final).reason is Reason.LOST_SAMPLE


@pytest.mark.parametrize(("machine", "limits", "joint"), SEARCHES, ids=["improved", "flow chart"])
def test_an_excursion_in_any_phase_ends_the_search_at_once(machine, limits, joint):
    phases = [before for before, _, _ in play(machine, limits, joint(), lambda _cycle, reading: reading)]
    for phase in set(phases):
        at = phases.index(phase) + 1

        def alter(cycle, reading, at=at):
            # farther off than the guard, for one cycle: back in its place the joint is another one
            return reading._replace(position_rad=SET_POINT_RAD - 0.2) if cycle == at else reading

        final = play(machine, limits, joint(), alter)[-1][2]
        assert (final.progress if machine is rest_search else final).reason is Reason.EXCURSION
