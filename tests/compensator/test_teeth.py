"""Where the teeth are in their free play, by the model."""

import pytest

from compensator.teeth import Teeth, follow

PERIOD_S, PLAY_RAD, INERTIA, UNSURE_A = 0.005, 0.02, 0.05, 0.002


def run(torques_a, teeth=Teeth(), play_rad=PLAY_RAD):  # noqa: B008 - immutable
    seen = []
    for torque_a in torques_a:
        teeth = follow(teeth, torque_a, UNSURE_A, INERTIA, play_rad, PERIOD_S)
        seen.append(teeth)
    return seen


def test_teeth_under_load_stay_together():
    last = run([0.3] * 50)[-1]
    assert (last.flank, last.apart_rad) == (1.0, 0.0)
    assert last.touch_since(40)
    assert not last.touch_since(60)


def test_a_load_that_turns_round_takes_the_time_of_a_fall_through_the_free_play():
    seen = run([0.3] * 50 + [-0.1] * 100)
    apart = [teeth for teeth in seen if teeth.apart_rad > 0.0]
    # x = 1/2 (c / J) t^2
    assert len(apart) * PERIOD_S == pytest.approx((2.0 * PLAY_RAD * INERTIA / 0.1) ** 0.5, abs=2 * PERIOD_S)
    assert seen[-1].flank == -1.0
    assert not any(teeth.touch_since(0) for teeth in apart)


def test_the_rattle_after_a_crossing_is_waited_for():
    seen = run([0.3] * 50 + [-0.1] * 100)
    touched = next(place for place, teeth in enumerate(seen) if teeth.flank < 0.0)
    crossing = seen[touched].crossing_cycles
    assert crossing > 20
    assert not seen[touched + crossing].touch_since(0)
    assert seen[touched + crossing + 2].touch_since(0)


def test_what_turns_back_half_way_closes_on_the_flank_that_it_left():
    seen = run([0.3] * 50 + [-0.1] * 20 + [0.3] * 40)
    assert seen[-1].flank == 1.0
    assert max(teeth.apart_rad for teeth in seen) < PLAY_RAD


def test_less_than_is_known_of_the_torque_parts_nothing():
    assert all(teeth.apart_rad == 0.0 for teeth in run([0.3] * 50 + [-0.9 * UNSURE_A] * 50))


def test_nothing_known_holds_nothing_up():
    assert Teeth().touch_since(1000)
