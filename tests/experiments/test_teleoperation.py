"""Teleoperation on the simulated pair of the paper, through the runner and its store."""

import numpy as np
import pytest

from bench.config.channels import PAIR_RECORDED
from bench.config.configuration import default_configuration, parse_configuration
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.errors import BenchError, ConfigurationError, LimitError
from bench.experiments.registry import find_kind, parse_parameters
from bench.recording_set import export_experiment, read_recording_set
from bench.runs.runner import Runner
from bench.store import Store
from tests.experiments.calibrated import calibrated_configuration

pytestmark = pytest.mark.timeout(300)  # seconds by itself; a shared machine that has to compile first may take minutes
SHORT = {"angles_rad": (1.2, -0.8), "rest_s": 1.0}


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    with Store.open(f"sqlite:///{tmp_path_factory.mktemp('pair') / 'bench.sqlite'}") as opened:
        yield opened


def ran(store, configuration, **parameters):
    runner = Runner(configuration, store)
    try:
        experiment_id = runner.start("teleoperation", parameters)
        assert runner.wait(280.0)
    finally:
        runner.close()
    return store.experiment(experiment_id)


@pytest.fixture(scope="module")
def carried(store):
    return ran(store, calibrated_configuration(seed=21), **SHORT)


@pytest.fixture(scope="module")
def leant(store):
    return ran(store, calibrated_configuration(seed=22), wall_rad=0.8, angles_rad=(0.83, 0.4), reach_s=3.0, rest_s=1.0)


def test_the_compensated_load_is_a_tenth_as_wrong_as_the_raw_current(carried):
    assert (carried.outcome, carried.source) == ("completed", "simulated")
    assert carried.results["trials"] == 2
    assert carried.results["error_ratio"] < 0.1
    assert not carried.results["compensated_limit_cycle"]


def test_the_compensated_load_comes_without_delay(carried):
    assert abs(carried.results["compensated_latency_s"]) < 0.05


def test_a_wall_is_felt(store, leant):
    trials = {trial.conditions["reflect"]: trial for trial in store.trials(leant.id)}
    rows = store.samples(trials["compensated"].id)
    pressed = np.flatnonzero(rows["interaction_n_m"] > 0.7)
    assert len(pressed) > 100  # more than the weight, which is 0.35 N m at the wall
    assert np.median(rows["reflected_n_m"][pressed]) > 0.7 * np.median(rows["interaction_n_m"][pressed])
    assert leant.results["error_ratio"] < 0.5
    assert trials["raw"].conditions["wall_rad"] == 0.8


def test_a_hit_is_felt_at_once_and_a_push_that_is_let_go_is_gone(leant):
    told = leant.results
    assert told["compensated_latency_s"] < 0.03
    assert told["compensated_rise_s"] < 0.04
    # nobody who is a cycle late does better: the hit itself is over by then
    assert told["compensated_reflected_error_max_g"] < 1.1 * told["compensated_least_error_max_g"] + 30.0
    # what a hit wedges is told by its momentum; static friction hides the rest
    assert told["compensated_late_error_max_g"] < 60.0 < 80.0 < told["raw_late_error_max_g"]


def test_raw_reflection_drags_and_the_compensated_one_hardly_drives_the_hand(carried, leant):
    for found in (carried.results, leant.results):
        assert found["raw_drag_n_m"] > 0.1
        # the master's own friction, 0.07 N m and more, takes that
        assert -0.03 < found["compensated_drag_n_m"] < 0.02


def test_the_hand_feels_what_is_reflected_beside_the_friction_of_its_own_joint(store, carried):
    compensated = store.trials(carried.id)[0]
    rows = store.samples(compensated.id)
    coupled = np.isfinite(rows["reflected_n_m"])
    felt = (rows["hand_n_m"] - rows["reflected_n_m"])[coupled]
    moving = np.abs(rows["master_velocity_rad_s"][coupled]) > 0.5
    # friction of the unloaded master: 0.07 to 0.1 A of 1 N m/A and what is viscous, against the motion
    assert np.mean(felt[moving] * np.sign(rows["master_velocity_rad_s"][coupled][moving])) > 0.05


def test_the_pair_ends_at_rest_and_off(store, carried):
    for trial in store.trials(carried.id):
        assert trial.outcome == "completed"
        assert trial.channels == PAIR_RECORDED
        rows = store.samples(trial.id)
        assert abs(rows["position_rad"][-1]) < 0.02
        assert rows["master_enabled"][-1] == 0.0


def test_what_is_exported_is_read_again(store, carried, tmp_path):
    export_experiment(store, carried.id, tmp_path / "pair.zip")
    again = read_recording_set(tmp_path / "pair.zip")
    trial = store.trials(carried.id)[0]
    rows = store.samples(trial.id)
    found = next(one for one in again.recordings if one.name == trial.name)
    for name in ("master_position_rad", "reflected_n_m", "interaction_n_m"):
        np.testing.assert_array_equal(found.channels[name], rows[name])


def test_both_drives_are_on_record(carried):
    assert carried.provenance["drive"]["device"] == carried.provenance["master_drive"]["device"]
    assert carried.provenance["configuration"]["master"]["drive"]["seed"] == 2


def test_the_same_seeds_give_the_same_samples(store):
    again = [
        ran(store, calibrated_configuration(seed=23), angles_rad=(0.5,), rest_s=0.5, reflect=("compensated",))
        for _ in range(2)
    ]
    first, second = (store.samples(store.trials(one.id)[0].id) for one in again)
    for name in PAIR_RECORDED:
        np.testing.assert_array_equal(first[name], second[name])


def test_raw_reflection_swings_in_a_light_hand_where_the_compensated_one_is_calm(store):
    plain = calibrated_configuration(seed=24)
    light = {"mass_kg": 0.5, "damping_n_s_m": 2.0, "stiffness_n_m": 30.0}
    master = plain.master.model_copy(
        update={
            "drive": SimulatedDriveSettings(seed=2, plant={"operator": light}),
            "limits": plain.master.limits.model_copy(update={"current_a": 6.0}),
            "reflection": plain.master.reflection.model_copy(update={"torque_n_m": 5.0, "slew_n_m_s": 500.0}),
        }
    )
    found = ran(
        store, plain.model_copy(update={"master": master}), angles_rad=(1.0,), rest_s=1.0, find_margin=True,
        largest_force_scale=16.0,
    ).results  # fmt: skip
    assert found["compensated_stability_margin"] == 16.0
    assert found["compensated_stability_margin_at_least"]
    assert 1.0 < found["raw_stability_margin"] < 6.0
    assert not found["raw_stability_margin_at_least"]


def test_a_bench_of_one_joint_is_told_what_to_add(store):
    alone = calibrated_configuration().model_copy(update={"master": None})
    with pytest.raises(ConfigurationError, match=r"add \[master.drive\] to bench.toml"):
        ran(store, alone)


def test_without_friction_curves_nothing_moves(store):
    with pytest.raises(ConfigurationError, match="calibrate run"):
        ran(store, default_configuration())


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"load_kg": 0.2}, "load_kg"),
        ({"angles_rad": (2.2,)}, "angles_rad"),
        ({"angles_rad": (1.5,), "motion_scale": 2.0}, "motion_scale times angles_rad"),
        ({"reach_s": 0.2}, "peak speed of a reach"),
        ({"wall_rad": 0.0}, "wall_rad"),
    ],
)
def test_what_the_pair_must_not_do_is_refused(wrong, named):
    kind, configuration = find_kind("teleoperation"), calibrated_configuration()
    with pytest.raises(BenchError, match=named):
        kind.refuse(parse_parameters(kind, wrong), configuration)


def test_a_reflection_beyond_the_master_s_current_is_refused():
    kind, plain = find_kind("teleoperation"), calibrated_configuration()
    strong = plain.master.reflection.model_copy(update={"torque_n_m": 3.0})
    changed = plain.model_copy(update={"master": plain.master.model_copy(update={"reflection": strong})})
    with pytest.raises(LimitError, match=r"master\.limits\.current_a, 2 A"):
        kind.refuse(parse_parameters(kind, {}), changed)


def test_a_real_joint_and_a_simulated_one_are_no_pair():
    values = default_configuration().model_dump(exclude_none=True)
    values["master"]["drive"] = {"kind": "roboclaw", "port": "/dev/ttyACM0"}
    mixed = parse_configuration(values, "bench.toml")
    with pytest.raises(ConfigurationError, match="no common time"):
        mixed.of_master()


def test_the_duration_is_about_what_it_takes(store, carried):
    kind = find_kind("teleoperation")
    stated = kind.duration_s(parse_parameters(kind, SHORT), calibrated_configuration())
    taken = sum(trial.rows for trial in store.trials(carried.id)) * 0.005
    assert 0.5 * taken < stated < 2.0 * taken
