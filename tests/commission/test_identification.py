"""The pushes on the paper's rig: what they tell, and that they stay small."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration, parse_configuration
from sim_backend.plant.presets import paper
from tests.experiments.bench_run import Ran

PLANT = paper()
TORQUE_N_M_A = PLANT.gear.ratio * PLANT.motor.torque_constant_n_m_a
INERTIA = (PLANT.arm.inertia_kg_m2 + PLANT.motor.rotor_inertia_kg_m2 * PLANT.gear.ratio**2) / TORQUE_N_M_A
STATIC_A = (PLANT.friction.static_n_m * PLANT.gear.ratio + PLANT.arm_friction.static_n_m) / TORQUE_N_M_A


def _bench(**plant):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["drive"] = {"kind": "sim", "plant": {"current_sensor": {"present": True}, **plant}}
    return parse_configuration(values, "test")


@pytest.fixture(scope="module", params=["current", "duty"])
def ran(request):
    return Ran(_bench(), "identification", effort=request.param)


def test_inertia_and_breakaway_are_those_of_the_joint(ran):
    results = ran.outcomes[0].results
    assert results["inertia_a_s2_rad"][0] == pytest.approx(INERTIA, rel=0.1)
    assert results["breakaway_a"] == pytest.approx(STATIC_A, rel=0.2)
    assert (results["demand_sign"], results["current_sign"]) == (1, 1)


def test_resistance_and_back_emf_are_those_of_the_motor(ran):
    results = ran.outcomes[0].results
    assert results["resistance_ohm"][0] == pytest.approx(PLANT.motor.resistance_ohm, rel=0.03)
    assert results["back_emf_v_s_rad"][0] == pytest.approx(TORQUE_N_M_A, rel=0.1)


def test_the_joint_goes_no_farther_than_twice_a_push_and_ends_at_rest(ran):
    farthest_rad = max(abs(way) for way in ran.outcomes[0].results["travel_rad"])
    for trial in range(len(ran.plans)):
        assert np.max(np.abs(ran.channel(trial, "position_rad"))) < 2.0 * farthest_rad
        assert ran.channel(trial, "position_rad")[-1] == ran.channel(trial, "position_rad")[-5]


def test_a_stiff_supply_does_not_sag_and_a_soft_one_does():
    stiff = Ran(_bench(), "identification").outcomes[0].results["supply_ohm"]
    assert "does not show" in stiff[3]
    soft = Ran(_bench(supply={"source_resistance_ohm": 1.0}), "identification").outcomes[0].results["supply_ohm"]
    assert soft[0] == pytest.approx(1.0, rel=0.2)


def test_an_encoder_that_stands_is_refused_before_the_ceiling_is_passed():
    values = _bench().model_dump(mode="json", exclude_none=True)
    values["drive"]["faults"] = [{"kind": "encoder-stuck", "at_s": 0.0}]
    ran = Ran(parse_configuration(values, "test"), "identification", ceiling_a=0.6, rate_a_s=2.0)
    assert ran.outcomes[0].outcome == "failed"
    assert "encoder plugged in" in ran.outcomes[0].reason
    assert np.nanmax(np.abs(ran.channel(0, "current_a"))) < 0.7
