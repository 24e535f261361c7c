"""Calibrations made from experiments in a store, kept there, and chosen by a bench."""

import numpy as np
import pytest

from bench import calibration
from bench.calibration.calibrate import FROM_CURVE, FROM_SEARCH
from bench.config.drives.kind import BrakeSettings
from bench.errors import ConfigurationError
from bench.recording_set import export_experiment, import_recording_set, read_recording_set
from bench.runs.runner import Runner
from compensator.errors import CalibrationError


@pytest.fixture(scope="module")
def row(store):
    return store.calibrations.get(calibration.calibrate(store, [1, 2], note="first"))


@pytest.fixture(autouse=True)
def nothing_named(store, configuration):
    yield
    calibration.use(store, configuration, None)


def with_rig(configuration, **gear):
    return configuration.model_copy(
        update={"rig": configuration.rig.model_copy(update={"gear": configuration.rig.gear.model_copy(update=gear)})}
    )


def test_it_says_what_it_was_made_from(store, row):
    assert (row.note, row.source, row.experiment_ids) == ("first", "simulated", [1, 2])
    assert set(row.trial_ids) <= {trial.id for trial in store.trials()}
    assert {point["trial_id"] for point in row.result["points"]} < set(row.trial_ids)
    assert row.provenance["software"]["version"]
    assert row.drive == {"kind": "sim", "preset": "paper", "plant": {}}


def test_f_load_comes_from_the_searches_at_angle_0(store, row):
    for curve in row.result["curves"]:
        assert curve["f_load_from"] == FROM_SEARCH
        # the same static friction, found at rest and at creeping speed; it scatters by 1.5 % from stop to stop. Within
        # the free play the motor lets go alone, without the arm's own 6 mA and what the teeth make of them
        assert -0.05 < curve["f_load_a"] / curve["static_a"] - 1.0 + 0.0075 / curve["static_a"] < 0.05
    alone = store.calibrations.get(calibration.calibrate(store, [1]))
    assert {curve["f_load_from"] for curve in alone.result["curves"]} == {FROM_CURVE}


def test_f_load_selects_the_curve_of_its_load(row):
    friction = calibration.friction_of(row)
    for curve in friction.curves:
        selected_a = friction.over_friction().current_a(50.0, curve.f_load_a)
        assert selected_a == pytest.approx(float(curve.curve().sliding_a(50.0)))


def test_an_imported_recording_set_gives_the_same_curves_from_its_samples(store, row, tmp_path):
    export_experiment(store, 1, tmp_path / "sweep.zip")
    imported = import_recording_set(store, read_recording_set(tmp_path / "sweep.zip"), "sweep")
    found = store.calibrations.get(calibration.calibrate(store, [imported]))
    assert found.source == "imported"
    assert found.drive == {}
    speed = np.linspace(2.0, 60.0, 30)
    pairs = zip(calibration.friction_of(found).curves, calibration.friction_of(row).curves, strict=True)
    for here, there in pairs:
        # 2 % of scatter along the path, of which windows of a fifth of a second average little out at low speed:
        # three standard deviations
        expected_a = there.curve().sliding_a(speed)
        assert here.curve().sliding_a(speed) == pytest.approx(expected_a, rel=0.06)


def test_unlike_experiments_are_not_mixed(store, configuration):
    runner = Runner(with_rig(configuration, backlash_rad=0.02), store)
    other = runner.start("load-sweep", {"loads_kg": (0.0,), "angles_rad": (0.0,), "searches": 1}, pace="fast")
    runner.close()
    with pytest.raises(CalibrationError, match=f"the rig of experiment {other} differs from that of experiment 1"):
        calibration.calibrate(store, [1, other])


def test_trials_without_motion_are_refused(store):
    before = len(store.calibrations.find())
    with pytest.raises(CalibrationError, match="0 trials of the balanced arm"):
        calibration.calibrate(store, [2])
    with pytest.raises(CalibrationError, match="there are 0 experiments"):
        calibration.calibrate(store, [])
    assert len(store.calibrations.find()) == before


def test_a_bench_uses_the_newest_that_fits_until_one_is_named(store, configuration, row):
    newest = calibration.calibrate(store, [1, 2])
    assert calibration.in_use(store, configuration).id == newest
    calibration.use(store, configuration, row.id)
    assert calibration.in_use(store, configuration).id == row.id
    calibration.use(store, configuration, None)
    assert calibration.in_use(store, configuration).id == newest


def test_another_rig_or_plant_does_not_fit(store, configuration, row):
    assert calibration.in_use(store, with_rig(configuration, backlash_rad=0.03)) is None
    with pytest.raises(ConfigurationError, match=f"calibration {row.id} is of rig 'paper' with other values"):
        calibration.use(store, with_rig(configuration, ratio=21.0), row.id)
    drive = configuration.drive.model_copy(update={"plant": {"friction": {"coulomb_n_m": 1e-3}}})
    assert calibration.in_use(store, configuration.model_copy(update={"drive": drive})) is None
    reseeded = configuration.drive.model_copy(update={"seed": 99})
    assert calibration.in_use(store, configuration.model_copy(update={"drive": reseeded})) is not None
    braked = configuration.drive.model_copy(update={"brake": BrakeSettings(by="drive")})
    assert calibration.in_use(store, configuration.model_copy(update={"drive": braked})) is not None


def test_an_experiment_runs_with_the_curves_in_use_and_its_record_says_so(store, configuration, row):
    calibration.use(store, configuration, row.id)
    runner = Runner(configuration, store)
    run = runner.start("load-sweep", {"loads_kg": (0.0,), "angles_rad": (0.0,), "searches": 1}, pace="fast")
    runner.close()
    friction = store.experiment(run).provenance["configuration"]["friction"]
    assert friction["calibration_id"] == row.id
    assert [curve["load_kg"] for curve in friction["curves"]] == [0.0, 0.1]


def test_the_picture_holds_points_and_curves_of_figs_2_and_3(configuration, row):
    picture = calibration.curve_data(row)
    motor, supply_v = configuration.rig.motor, configuration.rig.supply.voltage_v
    for one in picture.curves:
        assert min(one.points.motor_speed_rad_s) > 0.0
        assert any(one.points.backward)
        assert not all(one.points.backward)
        curve = one.curve
        for speed, friction_a, duty in zip(curve.motor_speed_rad_s, curve.friction_a, curve.friction_duty, strict=True):
            voltage_v = motor.resistance_ohm * friction_a + motor.back_emf_v_s_rad * speed
            assert duty == pytest.approx(voltage_v / supply_v)
