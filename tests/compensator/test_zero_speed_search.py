"""Fig. 5, on a joint whose breakaway currents and free play are known exactly."""

import dataclasses
from math import nan

import pytest

from compensator.errors import ModelParameterError, NoEstimateError
from compensator.rest import zero_speed_search
from compensator.rest.zero_speed_search import Phase, Reason, SearchReading, SearchSettings

COUNT_RAD = 1e-4
SETTINGS = SearchSettings(
    dead_band_rad=0.004,
    still_rad=1.5 * COUNT_RAD,
    onset_rad=4 * COUNT_RAD,
    free_play_rad=0.01,
    excursion_rad=0.15,
    current_step_a=0.004,
    step_cycles=4,
    ceiling_a=1.5,
    settle_timeout_cycles=500,
    creep_timeout_cycles=200,
)


class KnownJoint:
    """A joint without inertia: it stands within its friction band and slides at a speed in proportion beyond.

    `gap_rad`: free play in which the motor moves against its own friction alone, before it carries the arm.
    """

    def __init__(self, load_a=0.5, friction_a=0.4, gap_rad=0.0, gap_friction_a=0.1, set_point_rad=1.5):
        self.load_a, self.friction_a = load_a, friction_a
        self.gap_rad, self.gap_friction_a = gap_rad, gap_friction_a
        self.motor_rad = self.set_point_rad = set_point_rad
        self.low_flank_rad = set_point_rad - gap_rad / 2  # motor positions between which the arm does not move
        self.held_a = load_a

    def servo(self):
        """Back to the set point, arm and all; the current that then flows is anywhere in the band."""
        self.motor_rad += 0.2 * (self.set_point_rad - self.motor_rad)
        if abs(self.motor_rad - self.set_point_rad) < SETTINGS.dead_band_rad / 2:
            self.motor_rad = self.set_point_rad
        self.low_flank_rad = self.set_point_rad - self.gap_rad / 2

    def push(self, current_a):
        before_rad = self.motor_rad
        low_rad, high_rad = self.low_flank_rad, self.low_flank_rad + self.gap_rad
        at_high = self.motor_rad >= high_rad - 1e-12
        at_low = self.motor_rad <= low_rad + 1e-12
        loose = self.gap_rad > 0.0
        excess_a = current_a - (0.0 if loose else self.load_a)
        speed = 0.05
        if excess_a > 0 and loose and not at_high and excess_a > self.gap_friction_a:
            self.motor_rad = min(self.motor_rad + speed * 0.02, high_rad)
        elif excess_a < 0 and loose and not at_low and excess_a < -self.gap_friction_a:
            self.motor_rad = max(self.motor_rad - speed * 0.02, low_rad)
        elif (at_high or not loose) and current_a - self.load_a > self.friction_a:
            self.motor_rad += speed * 0.05
        elif (at_low or not loose) and current_a - self.load_a < -self.friction_a:
            self.motor_rad -= speed * 0.05
        if self.motor_rad > high_rad:
            self.low_flank_rad = self.motor_rad - self.gap_rad
        if self.motor_rad < low_rad:
            self.low_flank_rad = self.motor_rad
        return self.motor_rad - before_rad


def search(joint, settings=SETTINGS, alter=lambda _cycle, reading: reading, most_cycles=20_000):
    """Run a search to its end; returns the final state and every phase met, in order."""
    state = zero_speed_search.begin(joint.set_point_rad)
    command_a, phases = joint.held_a, [state.phase]
    for cycle in range(most_cycles):
        position_rad = round(joint.motor_rad / COUNT_RAD) * COUNT_RAD
        reading = alter(cycle, SearchReading(position_rad, command_a, command_a))
        state, ramp_a = zero_speed_search.advance(settings, state, reading)
        if state.phase is not phases[-1]:
            phases.append(state.phase)
        if state.finished:
            return state, phases
        if ramp_a is None:
            joint.servo()
            command_a = joint.held_a
        else:
            command_a = ramp_a
            joint.push(ramp_a)
    raise AssertionError(f"no end after {most_cycles} cycles, in {state.phase}")


@pytest.mark.parametrize(("load_a", "friction_a"), [(0.5, 0.4), (0.0, 0.1), (-0.3, 0.25), (0.05, 0.3)])
def test_the_band_is_found_within_a_step(load_a, friction_a):
    state, _ = search(KnownJoint(load_a, friction_a))
    found = state.estimate()
    assert state.max_current_a == pytest.approx(load_a + friction_a, abs=SETTINGS.current_step_a)
    assert state.min_current_a == pytest.approx(load_a - friction_a, abs=SETTINGS.current_step_a)
    assert found.load_current_a == pytest.approx(load_a, abs=SETTINGS.current_step_a)
    assert found.friction_current_a == pytest.approx(friction_a, abs=SETTINGS.current_step_a)


def test_the_phases_are_those_of_the_flow_chart():
    _, phases = search(KnownJoint())
    assert phases == [
        Phase.SETTLE_BEFORE_RAISING,
        Phase.RAISING,
        Phase.SETTLE_BEFORE_LOWERING,
        Phase.LOWERING,
        Phase.SETTLE_AFTER_LOWERING,
        Phase.DONE,
    ]


def test_free_play_is_not_taken_for_the_joint():
    # the motor crosses its gap at 0.1 A; the joint gives way at 0.4 A
    joint = KnownJoint(load_a=0.0, friction_a=0.4, gap_rad=0.01, gap_friction_a=0.1)
    state, _ = search(joint)
    assert state.max_current_a == pytest.approx(0.4, abs=SETTINGS.current_step_a)
    assert state.min_current_a == pytest.approx(-0.4, abs=SETTINGS.current_step_a)


def test_without_knowledge_of_the_gap_free_play_would_be_taken_for_the_joint():
    # the test above could not fail if the gap were never crossed
    joint = KnownJoint(load_a=0.0, friction_a=0.4, gap_rad=0.01, gap_friction_a=0.1)
    state, _ = search(joint, dataclasses.replace(SETTINGS, free_play_rad=0.0))
    assert state.max_current_a < 0.2


def test_the_ramp_waits_until_the_joint_is_settled_for_more_than_20_cycles():
    state = zero_speed_search.begin(1.5)
    reading = SearchReading(1.5, 0.5, 0.5)
    for _ in range(21):
        state, ramp_a = zero_speed_search.advance(SETTINGS, state, reading)
        assert ramp_a is None
    state, ramp_a = zero_speed_search.advance(SETTINGS, state, reading)
    assert state.phase is Phase.RAISING
    assert ramp_a == 0.5  # begins with the servo's own current


def test_currents_are_those_measured_not_those_commanded():
    # the drive gives 0.02 A less than it is asked for
    def offset(_cycle, reading):
        return reading._replace(current_a=reading.current_a - 0.02)

    state, _ = search(KnownJoint(load_a=0.5, friction_a=0.4), alter=offset)
    assert state.estimate().load_current_a == pytest.approx(0.48, abs=SETTINGS.current_step_a)


def failing(reason, joint=None, settings=SETTINGS, alter=lambda _cycle, reading: reading):
    state, _ = search(joint or KnownJoint(), settings, alter)
    assert (state.phase, state.reason) == (Phase.FAILED, reason)
    with pytest.raises(NoEstimateError, match=reason.value):
        state.estimate()


def test_current_ceiling():
    failing(Reason.CEILING, KnownJoint(friction_a=2.0))


def test_lost_settle():
    def shaken(cycle, reading):
        return reading._replace(position_rad=reading.position_rad + (0.001 if cycle % 10 == 0 else 0.0))

    failing(Reason.NOT_SETTLED, alter=shaken)


def test_outside_the_dead_band_is_not_settled():
    def displaced(_cycle, reading):
        return reading._replace(position_rad=reading.position_rad + 0.005)

    failing(Reason.NOT_SETTLED, alter=displaced)


@pytest.mark.parametrize("field", ["position_rad", "current_a"])
def test_lost_samples(field):
    failing(Reason.LOST_SAMPLE, alter=lambda cycle, r: r._replace(**{field: nan}) if cycle == 50 else r)


def test_excursion():
    failing(
        Reason.EXCURSION, alter=lambda cycle, r: r._replace(position_rad=r.position_rad + 0.2) if cycle == 50 else r
    )


def drifting(speed_rad_per_cycle):
    """Motion that does not ask for the current, from the moment the ramp begins."""
    start = []

    def alter(cycle, reading):
        if cycle < 23:
            return reading
        start.append(cycle)
        return reading._replace(position_rad=1.5 + speed_rad_per_cycle * len(start))

    return alter


def test_motion_before_any_change_of_current():
    # settles whenever the servo has it, and runs away whenever the search has
    state = zero_speed_search.begin(1.5)
    position_rad, ramp_a = 1.5, None
    for _ in range(5000):
        position_rad = 1.5 if ramp_a is None else position_rad + 5e-4
        state, ramp_a = zero_speed_search.advance(SETTINGS, state, SearchReading(position_rad, 0.5, 0.5))
        if state.finished:
            break
    assert state.reason is Reason.MOVED_EARLY
    assert state.unsettled == SETTINGS.retries


def test_motion_against_the_change_of_current():
    def falls(cycle, reading):
        return reading._replace(position_rad=1.5 - max(0, cycle - 60) * 0.001)

    failing(Reason.WRONG_WAY, alter=falls)


def test_a_creep_without_end_times_out():
    failing(Reason.TIME_OUT, KnownJoint(friction_a=1.4), alter=drifting(1e-5))


def test_a_finished_search_stays_finished():
    state, _ = search(KnownJoint())
    assert zero_speed_search.advance(SETTINGS, state, SearchReading(1.5, 0.5, 0.5)) == (state, None)


def test_an_unfinished_search_has_no_estimate():
    with pytest.raises(NoEstimateError, match="settle before raising"):
        zero_speed_search.begin(0.0).estimate()


@pytest.mark.parametrize(
    "wrong",
    [
        {"excursion_rad": 0.02},
        {"still_rad": 0.0},
        {"onset_rad": 1e-5},
        {"current_step_a": 0.0},
        {"step_cycles": 0},
        {"ceiling_a": -1.0},
    ],
)
def test_impossible_settings_are_refused(wrong):
    with pytest.raises(ModelParameterError):
        dataclasses.replace(SETTINGS, **wrong)
