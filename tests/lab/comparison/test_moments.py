"""When an effect takes the error away, on a joint whose hidden effect acts at known times."""

import numpy as np
import pytest

from compensator.lab.comparison.moments import MOST_MOMENTS, gained
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


@pytest.fixture(scope="module")
def fits():
    """A joint with viscous friction that differs by direction; a model without it, and one with it."""
    joint = Joint(extra=lambda x: 0.02 * abs(x.v))
    made = recordings(joint, Bench(duration_s=9.0), plans(loads_kg=(0.0, 0.2), repeats=1), seed=1)
    dataset = make_dataset(made, FACTS, Processing(rows="moving"))
    effects = list(default_effects(FACTS))
    return fit_model(dataset, effects), fit_model(dataset, [*effects, "viscous_asymmetry"])


def test_an_effect_acts_where_its_driver_is_large(fits):
    before, after = fits
    found = gained(before, after)
    assert 0 < len(found) <= MOST_MOMENTS
    speeds = []
    for one in found[:3]:
        trial = before.dataset.trials[one.moment.trial]
        time = before.dataset.time_of(trial)
        inside = (time >= one.moment.from_s) & (time <= one.moment.to_s)
        speeds.append(np.abs(trial.motion.velocity[trial.picked][inside]).mean())
    everywhere = np.concatenate([np.abs(trial.motion.velocity[trial.picked]) for trial in before.dataset.trials])
    assert min(speeds) > np.median(everywhere)


def test_moments_of_an_effect_are_closer_with_it_and_ranked_by_their_share(fits):
    found = gained(*fits)
    assert all(one.rms_after < one.moment.rms for one in found)
    shares = [one.share for one in found]
    assert shares == sorted(shares, reverse=True)
    assert 0.0 < sum(shares) <= 1.0


def test_a_model_gains_nothing_beside_itself(fits):
    before, _ = fits
    assert gained(before, before) == []
