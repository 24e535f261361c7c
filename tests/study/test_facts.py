"""What the lab is told of a rig: the back-EMF of a voltage."""

from dataclasses import replace

import pytest

from bench.config.rig import Rig
from bench.study.material import facts_of
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
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
