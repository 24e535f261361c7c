"""The improved search, on a joint whose breakaway currents are known."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.rest import rest_search
from compensator.rest.breakaway_fit import fit
from compensator.rest.rest_search import Phase, RestSearchSettings
from compensator.rest.zero_speed_search import Reason, SearchReading

COUNT_RAD = 1e-4
SETTINGS = RestSearchSettings(
    period_s=0.005,
    dead_band_rad=0.004,
    still_rad=1.5 * COUNT_RAD,
    threshold_rad=3.0 * COUNT_RAD,
    excursion_rad=0.15,
    ceiling_a=1.5,
    settle_timeout_cycles=400,
)


class KnownJoint:
    """Stands within its friction band; beyond, it gains speed with what is left of the current."""

    def __init__(self, load_a=0.5, forward_a=0.3, backward_a=0.3, sliding=0.6, scatter=0.0, seed=1):
        self.load_a, self.forward_a, self.backward_a = load_a, forward_a, backward_a
        self.sliding, self.scatter, self.generator = sliding, scatter, np.random.default_rng(seed)
        self.position_rad, self.speed, self.factor, self.held_a = 1.5, 0.0, 1.0, load_a

    def push(self, current_a):
        share = self.factor if self.speed == 0.0 else self.sliding
        excess_a = current_a - self.load_a
        band_a = share * (self.forward_a if (self.speed or excess_a) > 0 else self.backward_a)
        if self.speed == 0.0 and abs(excess_a) <= band_a:
            return
        way = np.sign(self.speed or excess_a)
        after = self.speed + 0.1 * (excess_a - way * band_a)
        if self.speed != 0.0 and after * self.speed <= 0.0:
            after, self.factor = 0.0, 1.0 + self.scatter * self.generator.standard_normal()
        self.speed = after
        self.position_rad += 0.005 * after

    def servo(self):
        self.speed, self.position_rad = 0.0, self.position_rad + 0.2 * (1.5 - self.position_rad)


def search(joint, settings=SETTINGS, alter=lambda _cycle, reading: reading, most_cycles=20_000):
    state, command_a, phases = rest_search.begin(1.5), joint.held_a, []
    for cycle in range(most_cycles):
        position_rad = np.floor(joint.position_rad / COUNT_RAD) * COUNT_RAD
        reading = alter(cycle, SearchReading(position_rad, command_a, joint.held_a))
        state, ramp_a = rest_search.advance(settings, state, reading)
        phases.append(state.phase)
        if state.finished:
            return state, phases
        command_a = joint.held_a if ramp_a is None else ramp_a
        joint.servo() if ramp_a is None else joint.push(command_a)
    raise AssertionError(f"no end after {most_cycles} cycles, in {state.phase}")


@pytest.mark.parametrize("load_a", [-0.3, 0.0, 0.5])
@pytest.mark.parametrize("friction_a", [0.1, 0.4])
def test_the_load_and_the_friction_are_found(load_a, friction_a):
    state, _ = search(KnownJoint(load_a, friction_a, friction_a))
    found = fit(state.progress.breakaways)
    assert state.phase is Phase.DONE
    # a cycle of the slower ramp is 0.75 mA, of the faster one 3 mA
    assert found.load_current_a.value == pytest.approx(load_a, abs=2e-3)
    assert found.friction_current_a.value == pytest.approx(friction_a, abs=8e-3)


def test_as_many_breakaways_each_way_at_each_rate_as_asked_for():
    state, _ = search(KnownJoint())
    assert len(state.progress.breakaways) == 2 * SETTINGS.pairs
    for rate in SETTINGS.fine_a_s:
        signs = [one.direction for one in state.progress.breakaways if one.rate_a_s == rate]
        assert sorted(signs) == [-1.0, -1.0, 1.0, 1.0]


def test_the_servo_is_not_needed_in_between_and_the_joint_hardly_moves():
    positions_rad = []

    def watched(_cycle, reading):
        positions_rad.append(reading.position_rad)
        return reading

    _, phases = search(KnownJoint(), alter=watched)
    first = phases.index(Phase.STAND)
    last = len(phases) - 1 - phases[::-1].index(Phase.RAMP)
    assert set(phases[first : last + 1]) == {Phase.STAND, Phase.RAMP}
    assert np.sum(np.abs(np.diff(positions_rad))) < 0.02


def test_the_current_of_a_breakaway_is_that_of_the_cycle_in_which_motion_was_seen():
    joint, seen = KnownJoint(), []
    state, command_a = rest_search.begin(1.5), joint.held_a
    while not state.finished:
        before = len(state.progress.breakaways)
        position_rad = np.floor(joint.position_rad / COUNT_RAD) * COUNT_RAD
        state, ramp_a = rest_search.advance(SETTINGS, state, SearchReading(position_rad, command_a, joint.held_a))
        if len(state.progress.breakaways) > before:
            seen.append((state.progress.breakaways[-1], command_a))
        command_a = joint.held_a if ramp_a is None else ramp_a
        joint.servo() if ramp_a is None else joint.push(command_a)
    assert len(seen) == 2 * SETTINGS.pairs
    for breakaway, flowing_a in seen:
        assert breakaway.current_a == pytest.approx(flowing_a, abs=1e-9)


def test_asymmetric_friction_shows_as_a_load_and_no_more():
    found = fit(search(KnownJoint(0.5, 0.36, 0.24))[0].progress.breakaways)
    assert found.load_current_a.value == pytest.approx(0.56, abs=2e-3)
    assert found.friction_current_a.value == pytest.approx(0.3, abs=8e-3)


def test_scatter_shows_as_what_it_is():
    scatters = [fit(search(KnownJoint(scatter=0.03, seed=seed))[0].progress.breakaways).scatter_a for seed in range(20)]
    assert np.sqrt(np.mean(np.square(scatters))) == pytest.approx(0.03 * 0.3, rel=0.4)


def test_a_jump_that_sets_the_joint_off_is_taken_back():
    # the fast ramp sees motion late: the first slow ramp would begin beyond the breakaway
    state, _ = search(KnownJoint(), replace(SETTINGS, coarse_share=0.005))
    assert state.phase is Phase.DONE
    assert state.progress.retries > 0
    assert fit(state.progress.breakaways).load_current_a.value == pytest.approx(0.5, abs=3e-3)


@pytest.mark.parametrize("broken", [{"position_rad": nan}, {"current_a": nan}])
def test_a_lost_sample_ends_the_search(broken):
    state, _ = search(KnownJoint(), alter=lambda cycle, reading: reading._replace(**broken) if cycle == 90 else reading)
    assert (state.phase, state.progress.reason) == (Phase.FAILED, Reason.LOST_SAMPLE)


def test_a_joint_that_holds_any_current_ends_at_the_ceiling():
    state, _ = search(KnownJoint(0.0, 9.0, 9.0))
    assert state.progress.reason is Reason.CEILING


def test_a_joint_that_does_not_settle_ends_the_search():
    state, _ = search(
        KnownJoint(), alter=lambda cycle, reading: reading._replace(position_rad=1.5 + 0.002 * (cycle % 2))
    )
    assert state.progress.reason is Reason.NOT_SETTLED


def test_a_joint_that_settles_elsewhere_ends_the_search():
    state, _ = search(KnownJoint(), alter=lambda _cycle, reading: reading._replace(position_rad=1.6))
    assert state.progress.reason is Reason.NOT_SETTLED


def test_a_joint_that_runs_away_ends_at_the_guard():
    state, _ = search(
        KnownJoint(), alter=lambda cycle, reading: reading if cycle < 60 else reading._replace(position_rad=1.8)
    )
    assert state.progress.reason is Reason.EXCURSION


def test_a_joint_that_goes_against_the_ramp_ends_the_search():
    def alter(cycle, reading):
        return reading if cycle < 60 else reading._replace(position_rad=1.5 - 5e-4)

    assert search(KnownJoint(), alter=alter)[0].progress.reason is Reason.WRONG_WAY


def test_a_joint_that_never_stands_is_given_up():
    def alter(cycle, reading):
        return reading if cycle < 30 else reading._replace(position_rad=1.5 + 4e-4 * (cycle % 2))

    state, _ = search(KnownJoint(), replace(SETTINGS, retries=1), alter)
    assert state.progress.reason in (Reason.MOVED_EARLY, Reason.NOT_SETTLED)


def test_what_ended_stays_ended():
    state, _ = search(KnownJoint())
    assert rest_search.advance(SETTINGS, state, SearchReading(0.0, 0.0, 0.0)) == (state, None)


@pytest.mark.parametrize(
    "wrong",
    [{"threshold_rad": 1e-5}, {"fine_a_s": (0.1,)}, {"fine_a_s": (0.1, 0.1)}, {"pairs": 1}, {"coarse_a_s": 0.0}],
)
def test_impossible_settings_are_refused(wrong):
    with pytest.raises(ModelParameterError):
        replace(SETTINGS, **wrong)
