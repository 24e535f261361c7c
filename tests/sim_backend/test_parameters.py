from typing import Any

import pytest

from sim_backend.errors import ParameterError
from sim_backend.mechanisms.motor.motor import VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.kernel import advance
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import Plant
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
        ("motor", {"resistance_ohm": float("inf")}, r"Motor.resistance_ohm = inf \[ohm\]: a finite number"),
        (
            "motor",
            {"resistance_ohm": 10**400},
            r"Motor.resistance_ohm = 10+ \[ohm\]: a finite number .* at most 1e\+12",
        ),
        ("motor", {"rotor_inertia_kg_m2": -3e-5}, r"Motor.rotor_inertia_kg_m2 = -3e-05 \[kg m2\]: .* greater than 0"),
        ("gear", {"ratio": 1e-200}, r"Gear.ratio = 1e-200 .*: too small to be told from 0"),
        ("gear", {"ratio": 1e200}, r"Gear.ratio = 1e\+200 .*: a finite number is wanted, at most 1e\+12"),
        ("friction", {"stribeck_rad_s": 0.0}, r"Friction.stribeck_rad_s = 0.0 \[rad/s\]: must be greater than 0"),
        ("encoder", {"counts_per_turn": 0}, r"Encoder.counts_per_turn = 0 \[counts per motor turn\]: .* at least 1"),
        ("encoder", {"speed_window_s": 1e5}, r"Encoder.speed_window_s = 100000.0 \[s\]: must be at most 1"),
        ("supply", {"duty_counts": 0}, r"Supply.duty_counts = 0 \[counts of full scale\]: must be at least 1"),
        ("supply", {"voltage_v": 0}, r"Supply.voltage_v = 0 \[V\]: must be greater than 0"),
        ("heat", {"present": True, "winding_j_k": 0}, r"Heat.winding_j_k = 0 \[J/K\]: must be greater than 0"),
        ("heat", {"start_c": -300}, r"Heat.start_c = -300 \[degC\]: must be at least -273.15"),
        ("overload", {"continuous_a": 0.0}, r"Overload.continuous_a = 0.0 \[A\]: must be greater than 0"),
        ("overload", {"peak_a": 0.0}, r"Overload.peak_a = 0.0 \[A\]: must be greater than 0"),
        (
            "arm",
            {"mass_kg": 3.0, "centre_of_mass_m": 0.5},
            r"Arm.inertia_kg_m2 = 0.01 .* at least 0.75 kg m2 .*Steiner",
        ),
        ("lubricant", {"vogel_k": 1e6}, r"Lubricant.vogel_k = 1000000.0 \[K\]: must be at most 5000"),
    ],
)
def test_impossible_plants_are_refused_with_parameter_value_unit_and_law(table: str, values: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        PlantParameters.from_dict({table: values}, base=presets.paper())


@pytest.mark.parametrize(
    ("wall_rad", "stop"), [(1.5, "upper_rad = 1.2"), (1.2, "upper_rad"), (-0.5, "lower_rad = -0.4")]
)
def test_a_wall_beyond_the_end_stops_is_refused(wall_rad: float, stop: str) -> None:
    stops = {"present": True, "lower_rad": -0.4, "upper_rad": 1.2}
    with pytest.raises(ParameterError, match=rf"EndStops.{stop}.* the wall at {wall_rad} rad lies beyond it"):
        parameters(end_stops=stops, wall={"present": True, "angle_rad": wall_rad})
    parameters(end_stops={**stops, "present": False}, wall={"present": True, "angle_rad": wall_rad})


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
    with pytest.raises(ParameterError, match=r"too coarse for spring.stiffness_n_m_rad = 1e\+09 .* at most .* s"):
        plant(spring={"stiffness_n_m_rad": 1e9})
    with pytest.raises(ParameterError, match=r"too coarse for cogging.amplitude_n_m \* cycles_per_turn = 1e\+06"):
        plant(cogging={"amplitude_n_m": 1e4, "cycles_per_turn": 100.0})
    plant(gear={"stiffness_n_m_rad": 1e6}, shaft={"compliance_rad_n_m": 1e-3})
    with pytest.raises(ParameterError, match=r"step = 0.001 \[s\]: must be above 0 and at most 0.0001"):
        Plant(parameters(), step_s=1e-3)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"winding_j_k": 1e-9}, r"too coarse for heat.winding_j_k = 1e-09 \[J/K\], which cools within 3e-09 s"),
        ({"housing_j_k": 1e-9}, r"too coarse for heat.housing_j_k = 1e-09 \[J/K\]"),
        ({"winding_to_housing_k_w": 1e-9}, r"too coarse for heat.winding_j_k = 15 \[J/K\]"),
    ],
)
def test_step_too_coarse_for_what_warms_is_refused(values: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        plant(heat={"present": True, **values})
    plant(heat=values)


def test_a_speed_window_shorter_than_a_step_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"Encoder.speed_window_s = 1e-06 \[s\]: shorter than a step, 0.0001 s"):
        plant(encoder={"counts_per_turn": 4096, "speed_window_s": 1e-6})


def test_presets_are_found_by_name() -> None:
    assert presets.by_name("paper") == presets.paper()
    with pytest.raises(ParameterError, match="preset 'papers' is unknown; known are paper"):
        presets.by_name("papers")


def test_whole_number_for_demand_is_no_other_kernel() -> None:
    plant = Plant(presets.paper())
    plant.advance(VOLTAGE, 0.0, 1)
    compiled = len(advance.signatures)  # type: ignore[attr-defined]
    plant.advance(VOLTAGE, 0, 1)
    assert len(advance.signatures) == compiled  # type: ignore[attr-defined]
