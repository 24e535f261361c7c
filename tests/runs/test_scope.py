"""What can be compensated, by drive, travel and rig: each rule on a joint where it bites, and where it does not."""

from dataclasses import replace
from math import asin, nan

import pytest

from bench.config.configuration import default_configuration, parse_configuration
from bench.runs.scope import Answer, scope_of, setting_to_add
from drivers.contract import Description, Mode, Untold


def drive(modes=(Mode.DUTY,), measured=("position_rad", "duty", "supply_v", "temperature_c"), step_rad=7.67e-5):
    return Description(
        "a drive", "", "", "", "", True, frozenset(modes), frozenset(measured), {"position_rad": step_rad}, 100.0, 0.2
    )


def joint(**sections):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    for section, changes in sections.items():
        values[section] |= changes
    return parse_configuration(values, "bench.toml")


def answers(configuration=None, found=None):
    scope = scope_of(configuration or joint(), found or drive())
    return {one.what.split(",")[0].split(" (")[0]: one for one in scope}


COMPENSATION = "friction taken off what the joint is asked for"
WEIGHT = "weight of arm and load"


def test_the_bench_of_the_paper_can_do_all_but_tell_the_temperature_of_the_lubricant():
    found = answers()
    assert [one.what for one in found.values() if one.answer is Answer.NO] == []
    assert found["friction that changes with temperature"].answer is Answer.IN_PART


def test_firmware_that_takes_positions_alone_can_be_known_and_not_compensated():
    found = answers(found=drive(modes=(Mode.POSITION,), measured=("position_rad", "current_a")))
    assert found[COMPENSATION].answer is Answer.NO
    assert "nothing can be added to its effort" in found[COMPENSATION].why
    assert found["friction at rest"].answer is Answer.NO
    assert found["free play of the gear"].answer is Answer.NO
    assert found["friction in motion"].answer is not Answer.NO  # by what it reports while it moves


def test_where_nothing_tells_the_effort_nothing_is_known():
    found = answers(found=drive(modes=(Mode.POSITION,), measured=("position_rad",)))
    assert {found[name].answer for name in (COMPENSATION, "friction in motion", WEIGHT)} == {Answer.NO}
    assert "neither current nor torque nor duty" in found["friction in motion"].why  # motor constants would not help


def test_what_the_drive_lacks_is_named_in_every_row_that_it_would_open():
    untold = Untold("set rated_current_a in [drive]", tells=True, takes=True)
    found = answers(found=replace(drive(modes=(Mode.POSITION,), measured=("position_rad",)), untold=untold))
    rows = (COMPENSATION, "friction at rest", "friction in motion", WEIGHT, "free play of the gear")
    assert [name for name in rows if untold.remedy not in found[name].why] == []
    assert "nothing can be added" not in found[COMPENSATION].why


def test_the_setting_that_is_to_be_added_is_told_by_itself():
    untold = Untold("set rated_current_a in [drive]", tells=True, takes=False)
    assert setting_to_add(joint(), drive()) == ""
    assert setting_to_add(joint(), replace(drive(), untold=untold)) == untold.remedy
    bare = joint(rig={"motor": {}})
    assert "back_emf_v_s_rad in [rig.motor]" in setting_to_add(bare, drive())
    assert setting_to_add(bare, drive(measured=("position_rad",))) == ""  # no setting would help


def test_a_drive_that_takes_positions_alone_says_so_whatever_would_let_it_tell_its_current():
    untold = Untold("set rated_current_a in [drive]", tells=True, takes=False)
    found = answers(found=replace(drive(modes=(Mode.POSITION,), measured=("position_rad",)), untold=untold))
    assert "nothing can be added to its effort" in found[COMPENSATION].why
    assert untold.remedy in found["friction in motion"].why


@pytest.mark.parametrize(
    ("measured", "words"),
    [(("current_a",), "the current that it measures"), (("torque_n_m",), "the torque that it tells")],
)
def test_it_says_where_the_effort_comes_from(measured, words):
    assert words in answers(found=drive(measured=measured))[COMPENSATION].why


def test_a_short_travel_bounds_the_speed_that_friction_is_seen_at():
    short = {"position_min_rad": -0.1, "position_max_rad": 0.1}
    found = answers(joint(limits=short, motion={"acceleration_rad_s2": 20.0}))["friction in motion"]
    assert found.answer is Answer.IN_PART
    # 0.2 rad at 20 rad/s2: v / 20 s to begin and to end, 0.2 s between: v2 / 20 + 0.2 v = 0.2
    assert "up to 0.83 rad/s" in found.why
    assert "do not extrapolate" in found.why


def test_a_lever_that_hardly_changes_hides_the_weight():
    near_level = {"position_min_rad": 1.3, "position_max_rad": 1.8}
    found = answers(joint(limits=near_level))
    assert found[WEIGHT].answer is Answer.NO
    assert "4% of its length" in found[WEIGHT].why  # the top, at 90 degrees, is between
    assert found["angle 0 by an arm that hangs straight down"].answer is Answer.NO
    assert answers(joint(limits={"position_min_rad": 0.0, "position_max_rad": asin(0.6)}))[WEIGHT].answer is Answer.YES


def test_the_motor_has_to_come_round():
    travel = {"position_min_rad": -0.1, "position_max_rad": 0.1}  # of 20 : 1, 0.64 turns of the motor
    assert answers(joint(limits=travel))["friction and ripple that go round with the motor"].answer is Answer.NO


def test_free_play_below_the_steps_of_the_position_is_not_seen():
    coarse = answers(found=drive(step_rad=0.01))["free play of the gear"]
    assert coarse.answer is Answer.NO
    assert "steps of the position" in coarse.why
    assert answers(found=drive(step_rad=nan))["free play of the gear"].answer is Answer.YES


@pytest.mark.parametrize("untold", [None, Untold("set rated_current_a in [drive]", tells=False, takes=True)])
def test_a_drive_without_any_mode_can_do_nothing_that_moves(untold):
    bare = replace(drive(modes=(), measured=("position_rad", "current_a")), untold=untold)
    found = answers(found=bare)
    for name in (COMPENSATION, "friction at rest", "friction in motion", WEIGHT, "free play of the gear"):
        assert found[name].answer is Answer.NO
        assert "it has no mode that can be used" in found[name].why
        assert untold is None or untold.remedy in found[name].why
