"""Parameters of a known law come back within what the noise allows."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.errors import UnknownEffectError, UnusableDataError
from compensator.lab.model.fit import fit_effects, fit_linear, fit_model
from compensator.lab.model.fitted import Fit, bounds_of
from compensator.lab.model.intervals import estimates
from compensator.lab.model.prediction import effort_per_torque, with_own_prediction
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.far_side import ARM_KG_M2, twisting
from tests.lab.synthetic import FACTS, G_M_S2, Bench, Joint, plans, recordings

DEFAULT = default_effects(FACTS)
QUIET = Bench(noise=0.0, quantum=0.0)
MEMORY = Bench(noise_memory=0.0)


@pytest.fixture(scope="module")
def noisy() -> Fit:
    return fit_model(make_dataset(recordings(bench=MEMORY, seed=5), FACTS, Processing()), DEFAULT)


def value(fit: Fit, effect: str, index: int = 0) -> float:
    return float(next(term for term in fit.terms if term.effect.name == effect).coefficients[index])


def test_without_noise_the_law_comes_back():
    fit = fit_model(make_dataset(recordings(bench=QUIET), FACTS, Processing(8.0)), DEFAULT)
    assert value(fit, "inertia") == pytest.approx(0.02, rel=0.005)
    assert value(fit, "inertia", 1) == pytest.approx(1.0, rel=0.005)
    assert value(fit, "gravity") == pytest.approx(0.25, rel=0.002)
    assert value(fit, "gravity", 1) == pytest.approx(1.0, rel=0.002)
    assert value(fit, "offset") == pytest.approx(0.01, rel=0.01)
    assert value(fit, "coulomb") == pytest.approx(0.08, rel=0.02)
    assert value(fit, "viscous") == pytest.approx(0.03, rel=0.02)
    assert value(fit, "stribeck") == pytest.approx(0.04, rel=0.04)
    speed, exponent = fit.shapes["stribeck"]
    assert speed == pytest.approx(0.25, rel=0.05)
    assert exponent == pytest.approx(1.0, abs=0.06)


def test_with_noise_within_what_least_squares_promises(noisy):
    """Coefficients of white noise scatter as sigma^2 (A'A)^-1; the filter leaves its bandwidth's share of sigma^2.

    The Stribeck shape is fitted as well, so that its tangents stand in the columns.
    """
    dataset, rows = noisy.dataset, noisy.training
    stribeck = noisy.terms[-1]
    tangents = []
    for index in range(2):
        moved = tuple(x * (1.0 + 0.01 * (i == index)) for i, x in enumerate(stribeck.shape))
        tangents.append((dataset.columns(stribeck.effect, moved) - noisy.columns[:, -1:]) @ stribeck.coefficients)
    columns = np.column_stack([noisy.columns, *tangents])[rows]
    in_band = 2.0 * dataset.cutoff_hz / MEMORY.rate_hz
    rows_per_independent = np.clip(1.25, 1.0, None)  # 2.5 rows per cut-off period are kept where 2 are independent
    covariance = MEMORY.noise**2 * in_band * rows_per_independent * np.linalg.inv(columns.T @ columns)
    sigma = np.sqrt(np.diag(covariance))[: len(noisy.coefficients)]
    true = np.array([0.02, 1.0, 0.25, 1.0, 0.01, 0.08, 0.03, 0.04])
    assert (np.abs(noisy.coefficients - true) < 4.0 * sigma + 0.004 * true).all()
    assert (sigma < 0.3 * true).all()  # so that the bound above says something
    assert np.std(noisy.residual[rows]) == pytest.approx(MEMORY.noise * np.sqrt(in_band), rel=0.15)


@pytest.mark.parametrize(("speed", "exponent"), [(0.2, 2.0), (0.5, 1.0), (0.25, 1.5), (0.18, 1.8), (0.4, 1.25)])
def test_the_stribeck_shape_is_found(speed, exponent):
    joint = Joint(static_excess=0.06, stribeck_speed=speed, stribeck_exponent=exponent)
    fit = fit_model(make_dataset(recordings(joint, QUIET), FACTS, Processing(8.0)), DEFAULT)
    assert fit.shapes["stribeck"] == pytest.approx((speed, exponent), rel=0.12)


def test_a_shape_is_searched_again_once_those_of_the_others_are_found():
    joint = Joint(extra=lambda x: 0.06 * np.sin(5.0 * x.q + 0.4) * np.sign(x.v))
    dataset = make_dataset(recordings(joint, bench=QUIET), FACTS, Processing(8.0))
    fit = fit_model(dataset, [*DEFAULT, "position_periodic_friction"])
    assert fit.shapes["position_periodic_friction"] == (5.0,)
    assert fit.shapes["stribeck"] == pytest.approx((0.25, 1.0), rel=0.12)


def test_shapes_that_are_given_are_kept():
    dataset = make_dataset(recordings(), FACTS, Processing(8.0))
    fit = fit_model(dataset, DEFAULT, shapes={"stribeck": (0.4, 1.5)})
    assert fit.shapes["stribeck"] == (0.4, 1.5)


def test_load_friction_comes_from_the_models_own_prediction():
    def loss(x):
        load = (0.25 + x.load_kg * G_M_S2 * x.arm_m) * np.sin(x.q) + x.load_kg * x.arm_m**2 * x.a
        return 0.15 * np.abs(load) * np.sign(x.v)

    dataset = make_dataset(recordings(Joint(extra=loss), QUIET), FACTS, Processing(8.0))
    fit = fit_model(dataset, [*DEFAULT, "load_friction"])
    assert value(fit, "load_friction") == pytest.approx(0.15, rel=0.02)
    assert value(fit, "gravity") == pytest.approx(0.25, rel=0.01)
    assert effort_per_torque(fit.dataset, fit.terms) == 1.0
    trial = fit.dataset.trials[-1]
    inside = trial.signals.usable
    expected = (0.25 + 0.25 * G_M_S2 * 0.3) * np.sin(trial.motion.position)
    expected += 0.25 * 0.3**2 * trial.motion.acceleration
    assert trial.motion.load_effort[inside] == pytest.approx(expected[inside], abs=0.01)


def test_the_predicted_load_never_holds_friction_or_the_rotor(noisy):
    predicted = with_own_prediction(noisy.dataset, noisy.terms)
    without_load = predicted.trials[0].motion  # nothing hangs: gravity of the arm alone
    assert without_load.load_effort == pytest.approx(value(noisy, "gravity") * np.sin(without_load.position))
    assert without_load.carried_slope == pytest.approx(value(noisy, "gravity") * np.cos(without_load.position))
    total = noisy.terms[0].coefficients[0] * without_load.acceleration + 0.25 * np.sin(without_load.position)
    assert np.abs(without_load.effort_rate).max() > np.abs(np.gradient(total, 1 / 200)).mean()


def test_a_delay_is_measured_in_seconds():
    made = recordings(bench=Bench(noise=0.0, quantum=0.0, delay_s=0.004))
    fit = fit_model(make_dataset(made, FACTS, Processing(8.0)), [*DEFAULT, "measurement_delay"])
    assert value(fit, "measurement_delay") == pytest.approx(0.004, rel=0.1)


def test_bounds_hold_and_are_told():
    dataset = make_dataset(recordings(Joint(viscous=-0.02)), FACTS, Processing())
    fit = fit_model(dataset, DEFAULT)
    assert value(fit, "viscous") == 0.0
    viscous = next(one for one in estimates(fit) if one.effect == "viscous")
    assert viscous.note == "held by its physical bound"
    assert viscous.low == 0.0


def test_static_friction_is_no_larger_than_the_largest_effort():
    """Where motion is quick, any static friction fits: it shows in no row."""
    dataset = make_dataset(recordings(), FACTS, Processing())
    high = bounds_of([effect_named(name) for name in ("viscous", "stribeck")], dataset).high
    assert high.tolist() == [np.inf, float(np.abs(dataset.effort).max())]


def test_columns_the_data_cannot_tell_apart_are_dropped_and_told():
    one_load = make_dataset(recordings(trials=plans(loads_kg=(0.2,))), FACTS, Processing())
    found = {one.parameter: one for one in estimates(fit_model(one_load, DEFAULT))}
    for name in ("load moment scale", "load inertia scale"):
        assert np.isnan(found[name].value)
        assert np.isnan(found[name].low)
        assert "cannot tell it apart" in found[name].note
    assert found["arm moment"].value == pytest.approx(0.25 + 0.2 * G_M_S2 * 0.3, rel=0.02)


def test_training_rows_alone_are_fitted(noisy):
    dataset = noisy.dataset
    effects = [term.effect for term in noisy.terms]
    rows = dataset.counted & (dataset.trial_index < 6)
    before = fit_linear(dataset, effects, rows, noisy.shapes, noisy.weight)
    dataset.effort[~rows] += 100.0
    try:
        after = fit_linear(dataset, effects, rows, noisy.shapes, noisy.weight)
    finally:
        dataset.effort[~rows] -= 100.0
    assert after.coefficients == pytest.approx(before.coefficients, rel=1e-12)


def test_what_cannot_be_fitted_says_so(noisy):
    few = np.zeros(len(noisy.dataset.effort), dtype=bool)
    few[:3] = True
    with pytest.raises(UnusableDataError, match="3 training rows for 8 coefficients; record longer or more trials"):
        fit_model(noisy.dataset, DEFAULT, few, noisy.shapes)
    with pytest.raises(UnusableDataError, match="no effects; add at least one"):
        fit_model(noisy.dataset, [])
    with pytest.raises(UnknownEffectError):
        fit_model(noisy.dataset, ["viscous", "magic"])


def test_two_loads_alone_still_part_arm_and_load():
    dataset = make_dataset(recordings(bench=QUIET, trials=plans(loads_kg=(0.0, 0.3))), FACTS, Processing(8.0))
    fit = fit_model(dataset, DEFAULT)
    assert (value(fit, "gravity"), value(fit, "gravity", 1)) == pytest.approx((0.25, 1.0), rel=0.01)


def test_a_shape_settles_with_the_load_that_it_is_of():
    """The load of a model without the spring is not that of the arm: beside it, the spring seems twice as quick."""
    made = recordings(Joint(extra=twisting), trials=plans((0.0, 0.25)), seed=4)
    told = replace(FACTS, arm_inertia_kg_m2=ARM_KG_M2)
    # below the resonance of 8 Hz rows hardly tell where it is
    fit = fit_model(make_dataset(made, told, Processing(cutoff_hz=12.0)), default_effects(told))
    found = fit_effects(fit, [*fit.names, "elasticity"])
    assert found.shapes["elasticity"][0] == pytest.approx(50.0 / (2.0 * np.pi), rel=0.05)
