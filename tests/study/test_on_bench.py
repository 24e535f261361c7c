"""A study's model back on the bench: the reflected load's error falls with the study's."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from bench.calibration import in_use, with_friction
from bench.cli.lab.study_bench import measure_models
from bench.config.reflected_load import torque_n_m_a
from bench.experiments.parts.load_follower import estimator_settings, joint_model
from bench.study.changes import add_effect
from bench.study.create import create_study
from bench.study.errors import StudyError
from bench.study.ladder import ladder
from bench.study.use import studied_model, use
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.online import works_online
from compensator.motion import load_estimator
from compensator.motion.load_estimator import Branch, Observation
from tests.experiments.calibrated import CURVES, REST, calibrated_configuration
from tests.figures.swing import error_g, true_model, with_model
from tests.study.test_suggest import run

BASE = ("inertia", "gravity", "offset", "coulomb", "viscous", "stribeck", "weight_friction", "load_friction")
MOTIONS = {"repeats": 1, "duration_s": 5.0, "loads_kg": [0.0, 0.05, 0.1]}


def bench_with(plant, seed=5):
    found = calibrated_configuration(seed)
    return found.model_copy(update={"drive": found.drive.model_copy(update={"plant": plant})})


CONFIGURATION = bench_with({"viscous_asymmetry": {"fraction": 0.5}})


@pytest.fixture(scope="module")
def number(store):
    made = create_study(
        store, "with a hidden effect", [run(store, "excitation", MOTIONS, configuration=CONFIGURATION)], base=BASE
    )
    add_effect(store, made.study_id, "viscous_asymmetry")
    return made.study_id


def test_the_reflected_load_is_nearer_with_each_rung(store, number):
    session = SimpleNamespace(open_store=lambda: nullcontext(store), configuration=lambda: CONFIGURATION)
    alone_g = measure_models(session, number, quiet=True)
    found = ladder(store, number)
    first, second = found.rungs
    assert second.held_out < first.held_out
    assert second.reflected_error_g < 0.8 * first.reflected_error_g
    assert second.reflected_error_g < alone_g  # the curves know nothing of the hidden effect
    assert measure_models(session, number, quiet=True) is None


def test_a_model_is_chosen_like_a_calibration(store, number):
    bare = CONFIGURATION.model_copy(update={"friction": None, "rest": None})
    with pytest.raises(StudyError, match="this bench has no calibration"):
        use(store, number, bare)
    base = store.calibrations.add(
        note="", source="simulated", rig=bare.rig.model_dump(mode="json", exclude_none=True),
        drive=bare.drive.model_dump(mode="json", exclude_none=True, exclude={"seed", "faults", "brake"}),
        provenance={}, experiment_ids=[], trial_ids=[],
        result={"curves": [one.model_dump() for one in CURVES], "rest": REST.model_dump()},
    )  # fmt: skip
    used = use(store, number, bare)
    chosen = in_use(store, bare)
    assert chosen is not None
    assert chosen.id == used.calibration_id != base
    told = with_friction(store, bare).friction
    assert told.study == studied_model(store, number, bare)[0]
    assert "viscous_asymmetry" in [one.effect for one in told.study.effects]
    assert told.curves == CURVES


@pytest.mark.parametrize("more", [(), ("spring",), ("coulomb_quadrant",), ("load_friction_quadratic",)])
def test_the_model_at_work_is_the_model_of_the_study(store, number, more):
    """All but inertia, by the estimator's own way, is what the fitted columns say, at moments of the study's trials."""
    from bench.experiments.parts.studied import online_friction
    from bench.study.material import load, load_model

    experiments = load(store, number).definition.experiment_ids
    made = create_study(store, "held against itself", experiments, base=(*BASE, "viscous_asymmetry", *more))
    studied, left = studied_model(store, made.study_id, CONFIGURATION)
    assert left == []
    online = online_friction(studied, CONFIGURATION.rig)
    material, model = load_model(store, made.study_id, None)
    fit = material.fit_of(model)
    index = next(i for i, trial in enumerate(material.trials) if trial.conditions["load_kg"] == 0.05)
    # the columns of the last pass were made with the load and the largest effort of the pass before
    largest_n_m = fit.dataset.trials[index].motion.largest_effort
    motion = with_own_prediction(fit.dataset, fit.terms).trials[index].motion.having(largest_effort=largest_n_m)
    rows = np.flatnonzero(np.abs(motion.velocity) > 3.0 * motion.slow)[::50]
    assert len(rows) > 10
    per_a = online.torque_n_m_a
    gravity_a = (0.05 * 9.80665 * motion.arm_m + online.own_n_m) / per_a
    for row in rows:
        wanted = sum(
            float((term.coefficients @ term.effect.columns(motion, term.shape))[row])
            for term in fit.terms
            if term.effect.name != "inertia"
        )
        one = slice(row, row + 1)
        weight_a = gravity_a * np.sin(motion.position[row])
        teeth_a = np.array([weight_a + motion.inertia_beyond * motion.acceleration[row] / per_a])
        found = online.current_a(
            motion.position[one], motion.velocity[one], motion.acceleration[row], teeth_a, gravity_a, 25.0
        )
        assert found[0] + weight_a == pytest.approx(wanted / per_a, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("known", [True, False])
def test_the_arm_falls_through_the_free_play_with_its_own_inertia(store, number, known):
    """Motion tells rotor and arm as one; the rig tells the arm's part, or that of the rotor, and the sum is kept."""
    rig = CONFIGURATION.rig
    studied, _ = studied_model(store, number, CONFIGURATION)
    per_a = torque_n_m_a(rig)
    rotor = rig.motor.rotor_inertia_kg_m2 * rig.gear.ratio**2 / per_a
    whole = studied.inertia_n_m_s2_rad / per_a
    arm = rig.arm.inertia_kg_m2 / per_a if known else whole - rotor
    told = rig if known else rig.model_copy(update={"arm": rig.arm.model_copy(update={"inertia_kg_m2": None})})
    friction = CONFIGURATION.friction.model_copy(update={"study": studied})
    model = joint_model(CONFIGURATION.model_copy(update={"friction": friction, "rig": told}))
    assert model.arm_inertia_a_s2_rad[0] == pytest.approx(arm)
    assert model.rotor_inertia_a_s2_rad + model.arm_inertia_a_s2_rad[0] == pytest.approx(whole)
    carried = studied.load_inertia_scale * CURVES[1].load_kg * rig.arm.length_m**2 / per_a
    assert model.arm_inertia_a_s2_rad[1] == pytest.approx(arm + carried)


def test_a_model_that_is_right_is_as_near_as_the_curves():
    """100 g swing at nearly their own frequency: the teeth carry next to nothing, and the free play counts most."""
    bench = calibrated_configuration(seed=1)
    assert error_g(with_model(bench, true_model(0.1)), 0.1, 0.5) < 1.15 * error_g(bench, 0.1, 0.5)


def test_what_the_teeth_lose_goes_by_the_load_of_each_moment():
    """Near the arm's own frequency weight and inertia nearly cancel: in each moment, not in one with another's mean."""
    bench = with_model(calibrated_configuration(), true_model(0.05))
    gear = bench.rig.gear.model_copy(update={"backlash_rad": 1e-6})
    bench = bench.model_copy(update={"rig": bench.rig.model_copy(update={"gear": gear})})
    model, settings = joint_model(bench), estimator_settings(bench)
    selector = (CURVES[0].f_load_a + CURVES[1].f_load_a) / 2.0
    joint, state, errors_a = model.under(selector), load_estimator.begin(selector), []
    terms = {one.effect: one.coefficients[0] for one in bench.friction.study.effects}
    dry_n_m, rate_rad_s = terms["coulomb"] + 0.05 * terms["weight_friction"], 2.0 * np.pi * 0.5
    for time_s in settings.period_s * np.arange(800):
        angle, speed = 0.785 * np.sin(rate_rad_s * time_s), 0.785 * rate_rad_s * np.cos(rate_rad_s * time_s)
        acceleration = -(rate_rad_s**2) * angle
        teeth_a = joint.gravity_at(angle) + joint.arm_inertia_a_s2_rad * acceleration
        dry_a = dry_n_m + terms["stribeck"] * np.exp(-((speed / 0.25) ** 2)) + terms["load_friction"] * abs(teeth_a)
        current_a = teeth_a + joint.rotor_inertia_a_s2_rad * acceleration + terms["viscous"] * speed
        observation = Observation(angle, current_a + np.sign(speed) * dry_a)
        state, estimate = load_estimator.advance(model, settings, state, observation)
        if estimate.branch is Branch.MOVING and abs(angle) < 0.4:
            errors_a.append(estimate.load_current_a - joint.gravity_at(angle))
    assert len(errors_a) > 200
    assert np.sqrt(np.mean(np.square(errors_a))) < 2e-3


@pytest.mark.parametrize(
    ("name", "works"),
    [("viscous_asymmetry", True), ("spring", True), ("viscous_temperature", True), ("pre_sliding", False),
     ("measurement_delay", False), ("warm_up", False), ("motor_warm_up", False), ("inertia", False),
     ("rate_dependent_breakaway", False)],
)  # fmt: skip
def test_what_needs_the_past_is_left_out(name, works):
    assert works_online(effect_named(name)) is works


def test_a_study_in_ampere_cannot_be_used(store):
    rig = CONFIGURATION.rig.model_copy(
        update={"motor": CONFIGURATION.rig.motor.model_copy(update={"torque_constant_n_m_a": None})}
    )
    bare = CONFIGURATION.model_copy(update={"rig": rig, "friction": None, "rest": None})
    experiment = run(store, "excitation", {**MOTIONS, "loads_kg": [0.0]}, configuration=bare)
    made = create_study(store, "in ampere", [experiment])
    with pytest.raises(StudyError, match="the compensator takes joint torque"):
        use(store, made.study_id, bare)
