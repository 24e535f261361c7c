from typing import Any

import pytest

from sim_backend import presets
from sim_backend.errors import ParameterError
from sim_backend.parameters import PlantParameters
from sim_backend.plant import Plant
from tests.sim_backend.plants import parameters, plant


@pytest.mark.parametrize(
    ("table", "values", "message"),
    [
        ("friction", {"static_n_m": 0.001}, r"Friction.static_n_m = 0.001 \[N m\]: .*never below Coulomb.*0.003 N m"),
        ("gear", {"backlash_rad": -0.01}, r"Gear.backlash_rad = -0.01 \[rad at the joint, total\]: must be at least 0"),
        ("gear", {"ratio": 0.0}, r"Gear.ratio = 0.0 \[motor turns per joint turn\]: must be greater than 0"),
        ("motor", {"resistance_ohm": -8}, r"Motor.resistance_ohm = -8 \[ohm\]: must be greater than 0"),
        ("arm", {"inertia_kg_m2": float("nan")}, r"Arm.inertia_kg_m2 = nan .*: a finite number"),
        ("load_friction", {"back_driving": 1.2}, r"LoadFriction.back_driving = 1.2 \[1\]: must be at most 1"),
        ("viscous_asymmetry", {"fraction": -2}, r"ViscousAsymmetry.fraction = -2 \[1\]: must be at least -1"),
        ("lubricant", {"reference_c": -120.0}, r"Lubricant.reference_c = -120.0 \[degC\]: .*above the divergence"),
        ("motor", {"resistence_ohm": 8.0}, r"plant.motor: unknown key 'resistence_ohm'; did you mean 'resistance_ohm'"),
        ("frictoin", {}, r"plant: unknown key 'frictoin'; did you mean 'friction'"),
        ("motor", {"resistance_ohm": "eight"}, r"Motor.resistance_ohm = 'eight' \[ohm\]: a finite number is wanted"),
        ("heat", {"present": 1}, r"plant.heat.present = 1: true or false is wanted"),
        ("motor", {"resistance_ohm": True}, r"plant.motor.resistance_ohm = True: a number is wanted"),
        ("motor", 8.0, r"plant.motor: a table of parameters is wanted, found 8.0"),
        ("bristle", {"stiffness_n_m_rad": 2.0, "damping_n_m_s_rad": 0.01}, r"make energy: s1\(w\) \|w\| <= .* 0.0056"),
        ("arm_bristle", {"elastic_fraction": 1.0}, r"plant.arm_bristle: Bristle.elastic_fraction = 1.0 .*at most 0.95"),
        ("wall", {"present": True, "angle_rad": 0.0}, r"Wall.angle_rad = 0.0 \[rad\]: the arm rests at angle 0"),
        ("end_stops", {"lower_rad": 0.1}, r"EndStops.lower_rad = 0.1 \[rad\]: .* lower stop must be below 0"),
        ("end_stops", {"upper_rad": -0.1}, r"EndStops.upper_rad = -0.1 \[rad\]: .* upper stop must be above 0"),
        ("shaft", {"compliance_rad_n_m": -1e-3}, r"Shaft.compliance_rad_n_m = -0.001 .*: must be at least 0"),
        ("dead_time", {"time_s": 3e-5}, r"DeadTime.time_s = 3e-05 \[s\]: must be less than half a PWM period, 2.5e-05"),
        ("overload", {"peak_a": 0.5}, r"Overload.peak_a = 0.5 \[A\]: must be more than the continuous current, 1 A"),
        ("overload", {"present": True}, r"Overload.present = True: I2t needs CurrentSensor.present"),
        ("dwell", {"slip_rad": 0.0}, r"Dwell.slip_rad = 0.0 \[rad\]: must be greater than 0"),
        ("operator", {"release_s": 0.0}, r"Operator.release_s = 0.0 \[s, the plant's time\]: must be greater than 0"),
        ("operator", {"grip_s": 2.0, "release_s": 1.0}, r"Operator.release_s = 1.0 .*lets go after it has taken hold"),
        ("operator", {"lever_m": 0.0}, r"Operator.lever_m = 0.0 .*must be greater than 0"),
        ("current_loop", {"present": True}, r"a loop needs CurrentSensor.present"),
    ],
)
def test_impossible_plants_are_refused_with_parameter_value_unit_and_law(table: str, values: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        PlantParameters.from_dict({table: values}, base=presets.paper())


def test_message_says_which_table_of_the_file_is_meant() -> None:
    with pytest.raises(ParameterError, match=r"^plant\.friction: Friction\.static_n_m"):
        PlantParameters.from_dict({"friction": {"static_n_m": 0.0}}, base=presets.paper())


def test_tables_override_a_preset_and_leave_the_rest() -> None:
    changed = PlantParameters.from_dict({"spring": {"stiffness_n_m_rad": 0.3}, "gear": {"ratio": 25}}, presets.paper())
    assert changed.spring.stiffness_n_m_rad == 0.3
    assert changed.gear.ratio == 25
    assert changed.gear.backlash_rad == presets.paper().gear.backlash_rad
    assert changed.friction == presets.paper().friction


def test_whole_plant_can_be_written_as_tables() -> None:
    with pytest.raises(ParameterError, match="the tables motor, supply, gear, arm, encoder are missing"):
        PlantParameters.from_dict({})
    with pytest.raises(ParameterError, match=r"plant.supply: missing 1 required .*'voltage_v'"):
        parameters(supply={}).from_dict({"supply": {}})
    assert parameters().motor.resistance_ohm == 2.0


def test_step_too_coarse_for_the_teeth_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"too coarse for Gear.stiffness_n_m_rad = 1e\+06 .* at most .* s"):
        plant(gear={"stiffness_n_m_rad": 1e6})
    for name in ("bristle", "arm_bristle"):
        with pytest.raises(ParameterError, match=rf"too coarse for {name}.stiffness_n_m_rad = 1e\+06 .* at most .* s"):
            plant(**{name: {"stiffness_n_m_rad": 1e6}})
    for name in ("wall", "end_stops"):
        with pytest.raises(ParameterError, match=rf"too coarse for {name}.stiffness_n_m_rad = 1e\+06 .* at most .* s"):
            plant(**{name: {"present": True, "stiffness_n_m_rad": 1e6}})
    plant(gear={"stiffness_n_m_rad": 1e6}, shaft={"compliance_rad_n_m": 1e-3})
    with pytest.raises(ParameterError, match=r"step = 0.001 \[s\]: must be above 0 and at most 0.0001"):
        Plant(parameters(), step_s=1e-3)


def test_presets_are_found_by_name() -> None:
    assert presets.by_name("paper") == presets.paper()
    with pytest.raises(ParameterError, match="preset 'papers' is unknown; known are paper"):
        presets.by_name("papers")
