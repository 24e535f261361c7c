"""Weights of rows: what scatters more counts less, as far as it does."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.examination import examine
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.left_over import left_over
from compensator.lab.left_over.remainder import remainder_of
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import BENDS, OUTLYING, RowWeights, weights_of
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather, gather_curves, with_noise
from tests.lab.synthetic import FACTS, Bench, Joint, recordings

LOST, NO_CURRENT, WAVE = 0.15, 0.03, 0.004


def estimated(one: Recording, random: np.random.Generator) -> Recording:
    """The current estimated from a duty of which a part is lost against the current: more than friction needs.

    Where hardly any current flows, a duty of any size up to the lost one makes none, and any may be there.
    """
    rest = {name: values for name, values in one.channels.items() if name != "torque_n_m"}
    current = one.channels["torque_n_m"]
    anything = np.interp(
        np.arange(len(current)), np.arange(0, len(current), 20), random.uniform(-1.0, 1.0, -(-len(current) // 20))
    )
    lost = LOST * np.where(np.abs(current) < NO_CURRENT, anything, np.sign(current))
    return replace(one, channels={**rest, "current_estimate_a": current + lost})


@pytest.fixture(scope="module")
def bent() -> Fit:
    random = np.random.default_rng(7)
    made = [estimated(one, random) for one in recordings(Joint(), Bench(noise=0.002), seed=3)]
    return fit_model(make_dataset(made, FACTS, Processing()), [*default_effects(FACTS), "dead_time"])


@pytest.fixture(scope="module")
def straight() -> Fit:
    return fit_model(make_dataset(recordings(seed=3), FACTS, Processing()), default_effects(FACTS))


def rms_by_bend(fit: Fit, weights: np.ndarray) -> np.ndarray:
    """Root mean square of weighted residuals where the model bends most, and where it hardly does."""
    steady = fit.dataset.steadiness[fit.training]
    weighted = weights * fit.residual[fit.training]
    sides = (steady < BENDS[1], steady >= BENDS[-1])
    return np.array([np.sqrt(np.mean(weighted[side] ** 2)) for side in sides])


def test_rows_that_a_bent_model_does_not_determine_scatter_more_than_its_bend_says(bent):
    steady = bent.dataset.steadiness[bent.training]
    before = rms_by_bend(bent, steady)
    assert before[0] > 3.0 * before[1]
    learnt = RowWeights.learnt(bent.dataset, bent.residual, bent.training)
    after = rms_by_bend(bent, steady * learnt.of(bent.dataset, bent.training))
    assert 0.6 < after[0] / after[1] < 1.6  # a class of few rows is drawn to what all have


def test_what_is_left_is_judged_where_the_model_determines_the_effort(bent):
    gathered = gather_curves(bent)
    everywhere = remainder_of(bent.dataset, bent.residual[gathered.rows], gathered.rows)
    assert left_over(gathered).remainder.share < 0.8 * everywhere.share


def test_determined_rows_are_those_that_do_not_bend(bent, straight):
    learnt = RowWeights.learnt(bent.dataset, bent.residual, bent.training)
    determined = learnt.determined(bent.dataset, bent.training)
    steady = bent.dataset.steadiness[bent.training]
    assert (determined <= steady).all()
    assert determined[steady > BENDS[-1]] == pytest.approx(steady[steady > BENDS[-1]])
    learnt = RowWeights.learnt(straight.dataset, straight.residual, straight.training)
    assert (learnt.determined(straight.dataset, straight.training) == 1.0).all()


def test_models_are_held_against_each_other_by_rows_that_they_determine():
    """A smaller effect beside a dead time: what a duty does that makes no current would hide its gain."""
    random = np.random.default_rng(7)
    joint = Joint(extra=lambda x: WAVE * np.cos(6.0 * x.q) * np.sign(x.v))
    made = [estimated(one, random) for one in recordings(joint, Bench(noise=0.002), seed=3)]
    fit = fit_model(make_dataset(made, FACTS, Processing()), [*default_effects(FACTS), "dead_time"])
    gathered = with_noise(gather(fit))
    screening = gathered.screened(gathered.named)
    waves = [one for one in screening.evidence if one.block.name == "position_periodic_friction"]
    assert examine(fit, gathered, screening, waves[:1])[0].gain.low > 0.15


def test_where_nothing_bends_residuals_of_each_kind_have_like_variance(straight):
    noisy = straight.residual * (1.0 + 3.0 * (np.abs(straight.dataset.target) > 0.1))
    acceleration = np.abs(straight.dataset.rows_of([trial.motion.acceleration for trial in straight.dataset.trials]))
    fast = acceleration > np.quantile(acceleration[straight.training], 0.75)
    scatter = np.where(fast, 2.0, 1.0) * noisy / noisy.std()
    learnt = RowWeights.learnt(straight.dataset, scatter, straight.training)
    weighted = learnt.of(straight.dataset, straight.training) * scatter[straight.training]
    sides = [np.std(weighted[side[straight.training]]) for side in (fast, ~fast)]
    assert sides[0] == pytest.approx(sides[1], rel=0.2)


def test_no_row_pulls_harder_than_an_outlying_one(straight):
    """Teeth that fly move a few rows by many times what the others scatter."""
    residual = straight.residual[straight.training].copy()
    usual = weights_of(straight, straight.training, residual) * residual
    residual[::100] *= 1000.0
    weighted = np.abs(weights_of(straight, straight.training, residual) * residual)
    assert weighted.max() < 1.1 * OUTLYING * np.std(usual)
    assert weighted[1::100] == pytest.approx(np.abs(usual[1::100]), rel=1e-6)
