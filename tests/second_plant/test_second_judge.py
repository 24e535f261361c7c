"""The lab's benchmark on the second plant: items, facts told, one answer."""

import json
from dataclasses import replace

import numpy as np
import pytest

from bench.errors import ParameterError
from bench.evaluation.blind.result import Result
from bench.evaluation.blind.second_judge import SECOND_FAMILIES, draw_second, judge_second, second_items_of
from bench.evaluation.blind.second_plant import (
    ABOVE_1,
    ABSORBED,
    KNOWN,
    LAWS,
    NAMES,
    OUTSIDE,
    recordings_of,
    rig_of,
    second_joint,
)
from compensator.lab.effects.catalogue import catalogue, default_effects
from compensator.lab.recordings.facts import Facts
from sim_backend.second_plant.joint import MECHANISMS


def test_every_effect_of_the_catalogue_is_hidden_by_a_mechanism_but_what_every_model_has():
    # every measured current of that plant is late and filtered, and viscous friction of foreign laws is of any power
    everywhere = {*default_effects(Facts()), "measurement_delay", "effort_filter", "measured_load", "viscous_power"}
    everywhere |= {"motor_warm_up"}  # hot_winding does it, by the name of a temperature that is measured
    everywhere |= {"hardening_spring"}  # its cable is as stiff everywhere
    looked_for = {name for name, effect in catalogue().items() if not effect.after}

    assert set(NAMES.values()) == looked_for - everywhere
    assert {*KNOWN, *ABSORBED, *OUTSIDE} == set(MECHANISMS)
    assert len(OUTSIDE) >= 8


def test_a_longer_run_begins_with_the_items_of_a_shorter_one():
    assert second_items_of(4, 3)[: len(second_items_of(4, 2))] == second_items_of(4, 2)
    with pytest.raises(ParameterError, match="no family 'memory'"):
        second_items_of(4, 1, ["memory"])


@pytest.mark.parametrize("name", ["tooth_loss", "worn_sector"])
def test_a_mechanism_gets_the_r_that_is_asked(name):
    joint = second_joint(21, (name,), (0.5,), "textbook")

    assert joint.evidences[0].ratio == pytest.approx(0.5, rel=0.35)


def test_what_the_catalogue_calls_a_joints_own_friction_is_no_wrong_name():
    textbook, foreign = (second_joint(21, (), (), level) for level in ("textbook", "foreign"))

    assert textbook.own == ()
    assert {"viscous_power", "pre_sliding", "position_periodic_friction"} <= set(foreign.own)
    assert {*LAWS.values(), *ABOVE_1.values()} <= set(catalogue())
    # the level is one function of the speed, however it bends: nothing of it is late
    assert LAWS["film_rad_s"] == LAWS["viscous_power"] == "viscous_power"


def test_an_exponent_above_1_is_what_the_catalogue_calls_quadratic():
    joint = second_joint(21, (), (), "textbook")
    thinning, churning = (
        replace(joint, drawn=replace(joint.drawn, physics=joint.drawn.physics._replace(viscous_power=power)))
        for power in (0.7, 1.3)
    )

    assert thinning.own == ("viscous_power",)
    assert churning.own == ("viscous_quadratic",)


def test_the_lab_sees_recordings_and_a_rig_without_what_is_hidden():
    rigs = set()
    for item in second_items_of(2, 3, ["complete"]):
        joint = draw_second(item)
        rig = rig_of(joint)
        rigs.add((rig.gear.ratio is None, rig.arm.inertia_kg_m2 is None, rig.motor.torque_constant_n_m_a is None))
        first = replace(joint, drawn=replace(joint.drawn, trials=joint.drawn.trials[:8]))  # each kind of motion once
        for one in recordings_of(first):
            assert np.isfinite(one.channels["position_rad"]).all()
            assert set(one.conditions) <= {"load_kg", "arm_m", "session_s"}
    assert len(rigs) > 1


def test_one_item_is_judged_and_its_result_survives_a_file():
    item = second_items_of(71, 1, ["outside"])[0]
    result = judge_second(item)

    assert result.names == ("",)
    assert 0.2 < result.standings[0].ratio < 2.0
    assert Result.from_json(json.loads(json.dumps(result.to_json()))) == result
    assert SECOND_FAMILIES[item.family].ratios == (0.3, 1.2)


def test_what_the_channel_of_another_mechanism_does_not_show_has_no_r():
    """A fault of the current's sensor is in no voltage, which a hot winding needs."""
    joint = second_joint(5, ("hot_winding", "sensor_gain"), (0.6, 0.5), "textbook")

    assert joint.drawn.sensors.effort in ("duty", "estimate")
    assert joint.evidences[0].ratio == pytest.approx(0.6, rel=0.35)
    assert joint.evidences[1].ratio < 0.01


@pytest.mark.parametrize("key", ["second-30042-1-complete-0", "second-30045-113-complete-0"])
def test_samples_that_are_now_fresh_and_now_old_look_like_no_filter_of_the_effort(key):
    """Noise of the acceleration, of which Wiener's gain takes the most in one joint, and too little in the other."""
    seed, plant = (int(part) for part in key.split("-")[1:3])
    (item,) = (one for one in second_items_of(seed, plant + 1, ["complete"]) if one.key == key)
    answer = judge_second(item).answer

    assert answer is not None
    assert answer.verdict == "nothing"
    assert "effort_filter" not in answer.named
