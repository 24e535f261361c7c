"""A model with a steep effect, as a power stage's dead time is: fitted by its tangent, judged by what it predicts."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import best_named
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model, with_coefficients
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import on_even_terms
from compensator.lab.model.prediction import beyond_tangent
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.far_side import ARM_KG_M2, GAP_RAD, loose_teeth
from tests.lab.synthetic import FACTS, Bench, Joint, Truth, plans, recordings

LOST, ORDER, WAVE = 0.1, 6.0, 0.03
DEFAULT = default_effects(FACTS)


def wavy(x: Truth) -> np.ndarray:
    return WAVE * np.cos(ORDER * x.q) * np.sign(x.v)


def estimated(one: Recording) -> Recording:
    """The same where the current is estimated from a duty of which a part is lost against the current."""
    rest = {name: values for name, values in one.channels.items() if name != "torque_n_m"}
    current = one.channels["torque_n_m"]
    return replace(one, channels={**rest, "current_estimate_a": current + LOST * np.sign(current)})


@pytest.fixture(scope="module")
def alone() -> Fit:
    recorded = [estimated(one) for one in recordings(Joint(extra=wavy), Bench(noise=0.003), seed=3)]
    return fit_model(make_dataset(recorded, FACTS, Processing(cutoff_hz=2.0)), [*DEFAULT, "dead_time"])


@pytest.fixture(scope="module")
def both(alone: Fit) -> Fit:
    kept = {**alone.shapes, "position_periodic_friction": (ORDER,)}
    return fit_model(alone.dataset, [*alone.names, "position_periodic_friction"], shapes=kept)


def test_every_effect_beside_a_steep_one_has_its_size(both):
    found = {term.effect.name: term.coefficients for term in both.terms}
    assert found["dead_time"] == pytest.approx([LOST], rel=0.1)
    assert found["coulomb"] == pytest.approx([0.08], rel=0.15)
    assert found["position_periodic_friction"] == pytest.approx([WAVE, 0.0], abs=0.1 * WAVE)


def test_what_is_fitted_is_what_the_model_predicts(both):
    assert both.dataset.is_bent
    again = with_coefficients(both, both.coefficients)
    assert np.abs(again.residual - both.residual).max() < 1e-5 * np.abs(both.dataset.effort).max()


def test_far_from_the_tangent_the_model_itself_is_asked(both):
    changed = both.coefficients + 0.02 * (np.arange(len(both.coefficients)) == 3)  # of Coulomb friction
    wanted = with_coefficients(both, changed).predicted
    tangent = both.columns @ changed - both.dataset.bent_effort
    more = np.concatenate(
        [beyond_tangent(both.dataset, both.terms, index, changed) for index in range(len(both.dataset.trials))]
    )
    assert np.linalg.norm(tangent + more - wanted) < 0.1 * np.linalg.norm(tangent - wanted)


def test_leaving_one_out_is_refitting_without_it(both):
    trials = both.dataset.trial_index
    own = trials == 4
    rest = fit_model(both.dataset, both.names, both.training & ~own, both.shapes)
    found = held_out(both)
    assert found.residual[found.unit == 4] == pytest.approx(rest.residual[own & both.training], abs=0.1 * LOST)


def test_a_trial_without_a_judged_row_is_passed_over(both):
    trials = list(both.dataset.trials)
    trials[4] = replace(trials[4], regimes=np.full_like(trials[4].regimes, Regime.TRANSIENT))
    dataset = replace(both.dataset, trials=tuple(trials))
    found = held_out(fit_model(dataset, both.names, dataset.in_regimes("moving"), both.shapes), "sliding")
    assert set(found.unit) == set(range(len(trials))) - {4}


def test_where_the_model_is_steep_rows_count_less(alone):
    whole = alone.dataset.constant > 0.9
    steady, predicted = alone.dataset.steadiness[whole], alone.predicted[whole]
    current = predicted - LOST * np.sign(predicted)
    assert np.median(steady[np.abs(current) < 0.02]) < 0.6 < 0.95 < np.median(steady[np.abs(current) > 0.1])
    assert (fit_model(alone.dataset, DEFAULT).weight == 1.0).all()


def test_a_second_effect_is_found_beside_it(alone, both):
    more, less = on_even_terms(held_out(both), held_out(alone))
    assert more.rms < 0.5 * less.rms
    assert best_named(alone, "sliding") == "position_periodic_friction"


def test_weights_go_over_residual_and_effort(both):
    whole = replace(held_out(both), weight=np.ones(int(both.training.sum())))
    half, other = on_even_terms(whole, replace(whole, weight=np.full(len(whole.residual), 0.5)))
    assert (half.rms, half.relative) == (other.rms, other.relative)
    assert half.rms == pytest.approx(0.5 * whole.rms)
    assert half.relative == pytest.approx(whole.relative)


def test_where_teeth_that_fly_may_turn_the_sign_rows_count_less():
    """The far side of known free play is not where a rigid gear has it, nor is the sign of the current."""
    made = [estimated(one) for one in recordings(Joint(extra=loose_teeth), Bench(noise=0.003), plans(), seed=3)]
    told = replace(FACTS, arm_inertia_kg_m2=ARM_KG_M2, arm_moment_n_m=Joint().arm_moment, backlash_rad=GAP_RAD)
    fit = fit_model(make_dataset(made, told, Processing(rows="moving")), [*DEFAULT, "dead_time"])
    motions = [trial.motion for trial in fit.dataset.trials]
    bent = fit.dataset.with_bend([motion.bend for motion in motions]).steadiness
    left = np.abs(fit.residual[fit.training])
    straight = bent[fit.training] > 0.9
    flown = fit.dataset.steadiness[fit.training] < 0.6
    assert np.median(left[straight & flown]) > 4.0 * np.median(left[straight & ~flown])
    tight = fit_model(make_dataset(made, FACTS, Processing(rows="moving")), [*DEFAULT, "dead_time"]).dataset
    assert all(np.all(trial.motion.doubt == 0.0) for trial in tight.trials)
