"""What the far side of teeth and shaft makes of the effort, where the owner knows how far it is behind."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.effects.mechanics import elasticity
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing
from compensator.lab.screening.nuisance import NEAR_REVERSALS, STIFFNESS_ABOUT, far_side_weight, nuisance_columns
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, recordings

GAP_RAD, STIFFNESS_N_M_RAD = 0.004, 200.0
TRIALS = [Plan(f"wide {load_kg}", ((1.0, 0.2, 0.0), (0.2, 0.7, 1.0)), load_kg=load_kg) for load_kg in (0.0, 0.1, 0.25)]


def weight_n_m(x, angle):
    return (Joint().arm_moment + x.weight_n_m) * np.sin(angle)


def behind(x) -> np.ndarray:
    """An arm that hangs half the gap, and what it winds up, behind the motor side."""
    carried = weight_n_m(x, x.q) + x.load_kg * x.arm_m**2 * x.a
    angle = x.q - 0.5 * GAP_RAD * np.sign(carried) - carried / STIFFNESS_N_M_RAD
    return weight_n_m(x, angle) - weight_n_m(x, x.q)


def fitted(facts: Facts) -> Fit:
    made = recordings(Joint(extra=behind), Bench(noise=2e-4), TRIALS, seed=5)
    return fit_model(make_dataset(made, facts, Processing()), default_effects(facts))


def test_an_arm_that_is_behind_weighs_less_by_what_is_known():
    told = replace(FACTS, backlash_rad=GAP_RAD, stiffness_n_m_rad=STIFFNESS_N_M_RAD, arm_inertia_kg_m2=1e-3)
    told = replace(told, arm_moment_n_m=Joint().arm_moment)
    fit = fitted(told)
    dataset = with_own_prediction(fit.dataset, fit.terms)
    lacking = nuisance_columns(dataset)["far_side_weight"]
    wide = np.column_stack([fit.columns, lacking])[fit.training]
    size = np.linalg.lstsq(wide, dataset.effort[fit.training], rcond=None)[0][-1]
    assert size == pytest.approx(-1.0, abs=0.15)
    motion = dataset.trials[2].motion
    highest = int(np.argmax(motion.position))
    expected_rad = 0.5 * GAP_RAD + motion.load_effort[highest] / STIFFNESS_N_M_RAD
    expected = motion.moment_n_m * np.cos(motion.position[highest]) * expected_rad  # the effort is a torque
    assert far_side_weight(motion)[highest] == pytest.approx(expected, rel=0.1)


def test_without_free_play_and_stiffness_nothing_is_behind():
    fit = fitted(FACTS)
    assert "far_side_weight" not in nuisance_columns(with_own_prediction(fit.dataset, fit.terms))
    level = replace(FACTS, backlash_rad=GAP_RAD, horizontal=True)
    assert "far_side_weight" not in nuisance_columns(dataset_of(level))


def test_which_columns_stand_there_is_a_matter_of_the_joint_not_of_the_trials():
    told = replace(FACTS, backlash_rad=GAP_RAD, stiffness_n_m_rad=STIFFNESS_N_M_RAD, arm_inertia_kg_m2=0.012)
    unloaded = dataset_of(told, TRIALS[:1])
    for show_in in ("sliding", "moving"):
        assert [*nuisance_columns(unloaded, show_in)] == [*nuisance_columns(dataset_of(told), show_in)]


def test_known_teeth_and_shafts_are_not_missing_in_slow_motion_either():
    told = replace(FACTS, backlash_rad=GAP_RAD, stiffness_n_m_rad=STIFFNESS_N_M_RAD, arm_inertia_kg_m2=0.012)
    fit = fitted(told)
    dataset = with_own_prediction(fit.dataset, fit.terms)
    sliding, moving = (nuisance_columns(dataset, show_in) for show_in in ("sliding", "moving"))
    assert {*moving} - {*sliding} == set(NEAR_REVERSALS)
    flying = sliding["known_play"][dataset.regime == Regime.SLIDING]
    assert np.abs(flying).max() > 0.0


def dataset_of(facts: Facts, trials: list[Plan] = TRIALS) -> Dataset:
    return make_dataset(recordings(trials=trials, seed=5), facts, Processing())


def test_an_arm_whose_weight_is_known_stays_on_one_flank_away_from_the_bottom():
    trials = [Plan(f"off the bottom {f_hz}", ((0.4, f_hz, 0.0),), centre=1.0) for f_hz in (0.2, 0.5)]
    loose = replace(FACTS, backlash_rad=GAP_RAD, arm_inertia_kg_m2=0.012)
    heavy = replace(loose, arm_moment_n_m=Joint().arm_moment)
    kept = [int(dataset_of(facts, trials).counted.sum()) for facts in (FACTS, heavy, loose)]
    assert kept[1] == kept[0]
    assert kept[2] < 0.8 * kept[0]


def test_a_known_stiffness_stands_for_teeth_that_swing_not_for_all_that_a_shaft_may_do():
    assert {damping for _, damping in STIFFNESS_ABOUT} < set(elasticity.DAMPINGS)
    assert max(damping for _, damping in STIFFNESS_ABOUT) < max(elasticity.DAMPINGS)
