"""From a speed sweep of the simulated bench to friction curves, their look-up and the motor's constants."""

import numpy as np
import pytest

from bench.calibration.curves import friction_fits, inertia_of
from bench.calibration.points import friction_points, identify_motor
from bench.config.configuration import default_configuration
from compensator.errors import CalibrationError, LookupRangeError
from compensator.motion.friction_lookup import FrictionLookup
from compensator.motor.dc_motor import MotorConstants
from tests.experiments.bench_run import Ran

CONFIGURATION = default_configuration()
MOTOR = MotorConstants(8.0, 0.05)  # of the preset
LEVELS = {"currents_a": (0.15, 0.25, 0.3, 0.35, 0.4), "speeds_rad_s": (0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)}
HELD_OUT_KG = 0.03


def with_current_sensor(seed=1):
    plant = {"current_sensor": {"present": True, "noise_a": 0.01, "offset_a": 0.005}}
    return CONFIGURATION.model_copy(
        update={"drive": CONFIGURATION.drive.model_copy(update={"plant": plant, "seed": seed})}
    )


@pytest.fixture(scope="module")
def rows():
    return Ran(CONFIGURATION, "speed-sweep", loads_kg=(0.0, HELD_OUT_KG, 0.05, 0.1), **LEVELS).summary["rows"]


@pytest.fixture(scope="module")
def fits(rows):
    return friction_fits(friction_points(row for row in rows if row["load_kg"] != HELD_OUT_KG))


@pytest.fixture(scope="module")
def lookup(fits):
    return FrictionLookup.over_load({load_kg: one.curve for load_kg, one in fits.items()})


def test_the_lookup_predicts_currents_at_a_load_it_never_saw(rows, fits, lookup):
    # What the calibration cannot know: friction wanders by 2 % along the path, over 0.05 rad, and a slow window sees
    # little more than one wandering: 2 mA of 0.1 A; a count of duty is 3 mA, half of it at most. Root sum square:
    # 2.5 mA rms; three times at most. What the arm still gains in speed is taken off with its inertia, in between too.
    inertia = (inertia_of(fits[0.0]) * 2 + inertia_of(fits[0.05]) * 3) / 5
    errors_a = np.array(
        [
            float(lookup.current_a(one.speed_rad_s, HELD_OUT_KG)) + inertia * one.acceleration_rad_s2 - one.current_a
            for one in friction_points(row for row in rows if row["load_kg"] == HELD_OUT_KG)[HELD_OUT_KG]
        ]
    )
    assert len(errors_a) >= 24
    assert np.sqrt(np.mean(errors_a**2)) < 0.0025
    assert np.max(np.abs(errors_a)) < 0.0075


def test_a_heavy_arm_that_still_gains_speed_spoils_no_curve(rows, fits):
    # within the travel, the heaviest arm still gains up to 2 % of its speed when its stroke counts as steady. Taken for
    # friction that is up to 10 mA at 5 rad/s; J of motor, arm and load at the shaft, with the loss in the mesh:
    for load_kg, found in fits.items():
        true = (0.012 + 1.25 * (0.01 + 0.25 * load_kg)) / 20.0
        assert inertia_of(found) == pytest.approx(true, rel=0.03)
    heavy = [row for row in rows if row["load_kg"] == 0.1]
    bare = [{**row, "windows": None} for row in heavy]
    speed = np.linspace(20.0, 110.0, 50)
    growth = 1.0 + 1.7 * 9.80665 * 0.1
    truth_a = 0.06 * growth + 0.0021 * speed + 0.00625 + 6.25e-5 * speed
    with_inertia, without = (
        np.max(np.abs(friction_fits(friction_points(one))[0.1].curve.sliding_a(speed) - truth_a))
        for one in (heavy, bare)
    )
    assert with_inertia < 0.003
    assert with_inertia < without


def test_the_lookup_predicts_steady_duties_too(rows, lookup):
    for row in rows:
        if row["load_kg"] == HELD_OUT_KG and row["saturated"]:
            predicted = float(lookup.duty(row["motor_speed_rad_s"], HELD_OUT_KG, MOTOR, row["supply_v"]))
            assert predicted == pytest.approx(row["duty"], abs=0.012 * 8.0 / 24.0)


def test_a_curve_that_does_not_know_the_load_would_predict_it_badly(rows, fits):
    # the test above could not fail if friction did not depend on the load
    held_out = [row for row in rows if row["load_kg"] == HELD_OUT_KG and row["saturated"]]
    errors_a = [float(fits[0.0].curve.sliding_a(row["motor_speed_rad_s"])) - row["current_a"] for row in held_out]
    assert np.sqrt(np.mean(np.square(errors_a))) > 0.02


def test_the_curves_are_those_of_the_plant(fits):
    # preset: (3 + 2 exp(-(w/5)^2)) mN m (1 + 1.7 W) and 0.105 mN m s/rad on 0.05 N m/A; bearings of the arm,
    # geared down and with the loss of a quarter in the mesh: 1.25 * (5 + 1 exp(-(w/5)^2)) mA at 1 A per N m, and
    # 0.0625 mA s/rad
    for load_kg, found in fits.items():
        growth = 1.0 + 1.7 * 9.80665 * load_kg
        coulomb_a, rise_a = 0.06 * growth + 0.00625, 0.04 * growth + 0.00125
        curve = found.curve
        assert curve.coulomb_a == pytest.approx(coulomb_a, abs=0.006)
        assert curve.static_a == pytest.approx(coulomb_a + rise_a, abs=0.01)
        assert curve.stribeck_speed_rad_s == pytest.approx(5.0, rel=0.3)
        assert curve.viscous_a_s_rad == pytest.approx(0.0021 + 6.25e-5, rel=0.06)
        assert found.scatter_a < 0.006


def test_beyond_the_heaviest_load_the_lookup_refuses(lookup):
    with pytest.raises(LookupRangeError, match=r"load is 0.15 kg; allowed is -0.01 .. 0.11 kg"):
        lookup.current_a(50.0, 0.15)


def test_with_a_current_sensor_the_sweep_identifies_the_motor():
    levels = {"currents_a": (0.03, 0.06, 0.25), "duties": (0.02, 0.2), "speeds_rad_s": (1.0, 3.0)}
    found = identify_motor(Ran(with_current_sensor(), "speed-sweep", loads_kg=(0.0, 0.1), **levels).summary["rows"])
    assert found.unidentified == {}
    for interval, true in ((found.resistance_ohm, 8.0), (found.back_emf_v_s_rad, 0.05)):
        assert interval.value == pytest.approx(true, rel=0.02)
        assert interval.high - interval.low < 0.08 * true
    assert found.offset_v.value == pytest.approx(-8.0 * 0.005, abs=0.01)


def test_without_a_current_sensor_it_says_what_it_cannot_tell(rows):
    found = identify_motor(rows)
    assert found.resistance_ohm is None
    assert "ohmmeter" in found.unidentified["resistance_ohm"]
    # Ke + R b = 0.05 + 8 * 2.16e-3 V s/rad
    assert found.back_emf_bound_v_s_rad.value == pytest.approx(0.0673, rel=0.03)


def test_rows_that_cannot_carry_a_curve_are_named_by_their_load(rows):
    fast = [row for row in rows if row["motor_speed_rad_s"] > 30.0 and row["saturated"]]
    with pytest.raises(CalibrationError, match=r"load 0 kg: the lowest speed is \d+"):
        friction_fits(friction_points(fast))
    with pytest.raises(CalibrationError, match=r"0 of \d+ strokes"):
        friction_points([row for row in rows if row["speed_rad_s"] == 0.0])
