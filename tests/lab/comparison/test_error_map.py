"""Where a model is wrong, on joints whose hidden effect has a known place."""

import numpy as np
import pytest

from compensator.lab.comparison.error_map import error_map
from compensator.lab.comparison.moments import moments
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


@pytest.fixture(scope="module")
def fit():
    """Friction that has more of a step than any of the model's effects: at forward speeds above 1 rad/s only."""
    joint = Joint(extra=lambda x: 0.05 * (x.v > 1.0))
    made = recordings(joint, Bench(duration_s=9.0), plans(loads_kg=(0.0, 0.2), repeats=1), seed=1)
    dataset = make_dataset(made, FACTS, Processing(rows="moving"))
    return fit_model(dataset, list(default_effects(FACTS)))


def test_every_counted_row_is_in_one_cell(fit):
    found = error_map(fit)
    assert found.count.sum() == fit.dataset.counted.sum()
    assert found.rms.shape == (len(found.down_edges) - 1, len(found.across_edges) - 1)


def test_the_known_loads_have_a_row_each(fit):
    found = error_map(fit)
    assert found.down == "load_kg"
    np.testing.assert_allclose(found.down_edges, [-0.1, 0.1, 0.3])


def test_cells_add_up_to_the_whole_error(fit):
    found = error_map(fit)
    known = np.isfinite(found.rms)
    rows = fit.dataset.counted
    whole = np.sum(fit.residual[rows] ** 2)
    few = rows.sum() - found.count[known].sum()
    assert np.sum(found.count[known] * found.rms[known] ** 2) == pytest.approx(
        whole, abs=few * np.max(fit.residual[rows] ** 2) + 1e-12
    )


def test_moments_meet_the_criteria_and_are_ranked(fit):
    found = moments(fit, {"velocity": (1.0, 10.0), "load_kg": (0.1, 0.3)})
    assert found
    power = [one.rms**2 * one.rows for one in found]
    assert power == sorted(power, reverse=True)
    for one in found:
        trial = fit.dataset.trials[one.trial]
        assert trial.motion.load_kg == 0.2
        time = fit.dataset.time_of(trial)
        inside = (time >= one.from_s) & (time <= one.to_s)
        assert (trial.motion.velocity[trial.picked][inside] > 1.0).sum() >= one.rows


def test_an_unknown_driver_is_named(fit):
    with pytest.raises(NotApplicableError, match=r"no driver 'moon' .* velocity"):
        moments(fit, {"moon": (0.0, 1.0)})
