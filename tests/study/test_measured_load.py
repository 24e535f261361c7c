"""A torque sensor beside the motor current: loss in the gear is judged on the load that is measured."""

import numpy as np

from bench.config.rig import Rig
from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.store import Store
from bench.study.create import create_study, describe
from bench.study.diagnosis.diagnose import diagnose
from bench.study.material import load_model
from compensator.lab.recordings.recording import Recording

RIG = Rig.model_validate({"name": "gear on a load machine", "horizontal": True})
PER_N_M, LOSS = 0.8, 0.12


def trial(seed: int, loss: float) -> Recording:
    """The joint moves to and fro while a load machine pulls as it likes."""
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, 20.0, 0.005)
    position = 1.2 * np.sin(2.0 * np.pi * 0.4 * time_s + seed) + 0.4 * np.sin(2.0 * np.pi * 0.93 * time_s)
    velocity = np.gradient(position, time_s)
    load = 1.5 * np.sin(2.0 * np.pi * 0.23 * time_s + 2.0 * seed) + 0.6
    current = PER_N_M * load + 0.05 * np.gradient(velocity, time_s) + 0.2 * np.sign(velocity) + 0.05 * velocity
    current = current + loss * np.abs(PER_N_M * load) * np.sign(velocity) + 0.02 * random.standard_normal(len(time_s))
    sensor = load + 0.005 * random.standard_normal(len(time_s))
    channels = {"time_s": time_s, "position_rad": position, "current_a": current, "load_torque_n_m": sensor}
    return Recording(f"pull {seed}", "pull", {}, channels)


def study_of(store: Store, loss: float) -> int:
    made = RecordingSet("gear", RIG, [trial(seed, loss) for seed in range(4)])
    return create_study(store, "gear", [import_recording_set(store, made, "gear")]).study_id


def test_the_measured_load_stands_in_the_first_model(store: Store) -> None:
    study_id = study_of(store, 0.0)
    assert describe(store, study_id).models[0].effects[:2] == ["inertia", "measured_load"]
    material, model = load_model(store, study_id, None)
    fit = material.fit_of(model)
    found = dict(zip(fit.names, (term.coefficients for term in fit.terms), strict=True))
    assert abs(found["measured_load"][0] - PER_N_M) < 0.01


def test_loss_in_the_gear_is_named_by_the_measured_load(store: Store) -> None:
    found = diagnose(store, study_of(store, LOSS))
    assert found.verdict == "missing"
    assert "load_friction" in found.classes[0].effects
