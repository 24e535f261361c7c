"""A fitted model moved under the law that its trials ran under."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.closed_loop import simulation
from compensator.lab.closed_loop.control_law import ControlLaw
from compensator.lab.closed_loop.resistance import Resistance, resistances
from compensator.lab.closed_loop.simulation import simulate
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_model, with_coefficients
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing
from tests.lab.closed_loop.servoed import FACTS, Joint, recordings, run

MODEL = ["inertia", "gravity", "coulomb", "viscous"]
JOINT = Joint()


def fitted(of: list[Recording], effects: list[str]) -> Fit:
    return fit_model(make_dataset(of, FACTS, Processing()), effects)


def with_truth(fit: Fit, joint: Joint) -> Fit:
    truth = {
        "inertia": [joint.inertia, 0.0],
        "gravity": [joint.moment, 0.0],
        "coulomb": [joint.coulomb],
        "viscous": [joint.viscous],
        "load_friction": [joint.share_of_weight],
    }
    return with_coefficients(fit, np.concatenate([truth[name] for name in fit.names]))


@pytest.fixture(scope="module")
def fit() -> Fit:
    return fitted(recordings(JOINT), MODEL)


def apart(fit: Fit, joint: Joint, told: ControlLaw | None = None) -> tuple[float, float]:
    """How far the lab's joint is from one that is stepped by itself, and that from the measured one [rad, rms]."""
    trial = fit.dataset.trials[0]
    found = simulate(fit, trial, told)
    truly = np.interp(trial.signals.time_s, *(run(joint)[name] for name in ("time_s", "position_rad")))
    inside = found.closed.copy()
    inside[: 2 * int(trial.signals.rate_hz)] = False  # until both have forgotten where they began
    ours, measured = found.position - truly, truly - trial.signals.position
    assert found.settled
    return float(np.sqrt(np.mean(ours[inside] ** 2))), float(np.sqrt(np.mean(measured[inside] ** 2)))


def test_the_true_model_goes_where_the_joint_went(fit):
    ours, _ = apart(with_truth(fit, JOINT), JOINT)
    assert ours < 2e-4


@pytest.mark.parametrize("change", [{"coulomb": 0.1}, {"moment": 0.3}, {"inertia": 0.09}, {"viscous": 0.3}])
def test_another_model_goes_where_another_joint_would(fit, change):
    other = replace(JOINT, **change)
    ours, theirs = apart(with_truth(fit, other), other)
    assert ours < 0.1 * theirs  # what a reading at 200 Hz leaves of where friction changes sign is 0.2 mrad


def test_friction_that_grows_with_the_load_is_found_by_relaxation(fit):
    """The load that a model predicts moves with its joint."""
    wide = fitted(recordings(JOINT), [*MODEL, "load_friction"])
    other = replace(JOINT, share_of_weight=0.3)
    ours, theirs = apart(with_truth(wide, other), other)
    assert ours < 0.1 * theirs  # what a reading at 200 Hz leaves of where friction changes sign is 0.2 mrad


def test_a_dead_band_is_the_bench_s_to_tell():
    joint = replace(JOINT, dead_band=0.01)
    fit = fitted(recordings(joint), MODEL)
    other = replace(joint, coulomb=0.05)
    told = ControlLaw(joint.stiffness, 0.0, joint.damping, "bench", joint.dead_band)
    ours, theirs = apart(with_truth(fit, other), other, told)
    assert ours < 0.25 * theirs  # in a dead-band friction decides where a joint stops


def test_where_the_power_is_off_the_joint_is_where_it_was_measured(fit):
    first, *others = recordings(JOINT)
    off = (first.channels["time_s"] > 2.0) & (first.channels["time_s"] < 3.0)
    cut = replace(first, channels={**first.channels, "enabled": np.where(off, 0.0, 1.0)})
    model = with_truth(fitted([cut, *others], MODEL), replace(JOINT, coulomb=0.05))
    trial = model.dataset.trials[0]
    found = simulate(model, trial)
    assert not found.closed[off].any()
    assert np.abs(found.position - trial.signals.position)[off].max() == 0.0
    assert np.abs(found.position - trial.signals.position)[found.closed].max() > 1e-3


def test_a_model_without_inertia_does_not_move(fit):
    with pytest.raises(UnusableDataError, match="no inertia"):
        simulate(fitted(recordings(JOINT), MODEL[1:]), fit.dataset.trials[0])


def test_a_trial_of_little_effort_is_moved_as_it_was_fitted(fit, monkeypatch):
    """By the largest effort of all trials, not of its own: a dead time would be of another size."""
    asked: list[float] = []

    def seen(model: Fit, motions: Dataset) -> list[Resistance]:
        asked.append(motions.scales.largest_effort)
        return resistances(model, motions)

    monkeypatch.setattr(simulation, "resistances", seen)
    predicted = with_own_prediction(fit.dataset, fit.terms)
    simulate(replace(fit, dataset=predicted), fit.dataset.trials[0])
    assert set(asked) == {predicted.trials[0].motion.largest_effort}
    assert asked[0] > 0.0


def test_a_model_that_corrects_the_position_moves_each_of_several_trials():
    made = [replace(one, name=f"{one.name}-{number}") for number, one in enumerate(recordings(JOINT) * 2)]
    fit = fitted(made, MODEL)
    corrected = replace(fit, dataset=replace(fit.dataset, uncorrected=fit.dataset))
    trial = fit.dataset.trials[1]
    np.testing.assert_allclose(simulate(corrected, trial).position, simulate(fit, trial).position)


def test_a_joint_that_runs_away_ends_without_a_warning(fit):
    """Trials that hardly accelerate leave an inertia of next to nothing, and a friction that may be negative."""
    light = with_truth(fit, replace(JOINT, inertia=1e-6, viscous=-1.0))
    found = simulate(light, fit.dataset.trials[0], ControlLaw(0.0, 0.0, 0.0, "bench", 0.0))
    assert not found.settled
    assert np.isfinite(found.effort).all()
    assert np.abs(found.position).max() <= 1e6
