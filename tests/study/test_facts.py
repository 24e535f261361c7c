"""What the lab is told of a rig: the back-EMF of a voltage, and what the position sensor resolves."""

from dataclasses import replace
from math import pi

import pytest

from bench.config.rig import Rig, resolution_rad
from bench.study.material import facts_of
from compensator.lab.effects.catalogue import catalogue, default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.effects.test_effects import motion
from tests.lab.synthetic import recordings

CONSTANTS = {"torque_constant_n_m_a": 0.04}


@pytest.mark.parametrize(
    ("motor", "gear", "told"),
    [
        (CONSTANTS, {"ratio": 100.0}, 4.0),
        ({**CONSTANTS, "back_emf_v_s_rad": 0.05}, {"ratio": 100.0}, 5.0),
        (CONSTANTS, {}, None),
        ({}, {"ratio": 100.0}, None),
    ],
)
def test_the_back_emf_at_the_joint_is_known_with_a_constant_and_the_gear_ratio(motor, gear, told):
    found = facts_of(Rig.model_validate({"name": "a", "motor": motor, "gear": gear})).back_emf_v_s_rad
    assert found == (None if told is None else pytest.approx(told))


@pytest.mark.parametrize(
    ("sensor", "gear", "turns", "counts"),
    [
        ({"counts_per_turn": 1000.0}, {"ratio": 50.0}, 50.0, 50_000.0),
        ({"counts_per_turn": 1000.0, "at": "joint"}, {"ratio": 50.0}, 1.0, 1000.0),
        ({"counts_per_turn": 1000.0, "at": "joint"}, {}, 1.0, 1000.0),
        ({"counts_per_turn": 1000.0}, {}, None, None),
    ],
)
def test_a_sensor_at_the_joint_turns_with_it(sensor, gear, turns, counts):
    rig = Rig.model_validate({"name": "a", "sensor": sensor, "gear": gear})
    facts = facts_of(rig)
    assert facts.sensor_turns == turns
    assert facts.position_count == (None if counts is None else pytest.approx(2.0 * pi / counts))
    if counts is not None:
        assert resolution_rad(rig) == pytest.approx(2.0 * pi / counts)


def test_an_encoder_off_its_centre_swings_with_what_carries_it():
    at_motor, at_joint = (Facts(gear_ratio=76.0, sensor_at_joint=at) for at in (False, True))
    shapes = catalogue()["encoder_eccentricity"].shapes
    assert shapes(replace(motion(), facts=at_motor)) == [(76.0,), (152.0,)]
    assert shapes(replace(motion(), facts=at_joint)) == [(1.0,), (2.0,)]


@pytest.mark.parametrize(("channel", "held"), [("duty", 4.0), ("torque_n_m", 0.0)])
def test_only_a_voltage_holds_it(channel, held):
    made = []
    for one in recordings(seed=1):
        channels = dict(one.channels)
        channels[channel] = 0.1 * channels.pop("torque_n_m")
        channels["supply_v"] = 24.0 + 0.0 * channels["time_s"]
        made.append(replace(one, channels=channels))
    facts = Facts(arm_m=0.3, back_emf_v_s_rad=4.0)
    fit = fit_model(make_dataset(made, facts, Processing(8.0)), default_effects(facts))
    predicted = with_own_prediction(fit.dataset, fit.terms)
    assert {trial.motion.back_emf for trial in predicted.trials} == {held}
