"""From which size effects show beside a model."""

import numpy as np
import pytest

from compensator.lab.comparison.judgeable import judgeable
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, recordings


def smallest(joint):
    dataset = make_dataset(recordings(joint, seed=4), FACTS, Processing())
    return {one.effect.name: one.smallest for one in judgeable(fit_model(dataset, default_effects(FACTS)))}


def test_an_effect_near_reversals_is_held_against_what_is_left_there():
    def jolts(x):
        return 0.1 * np.cos(150.0 * x.q) * np.exp(-((x.v / 0.05) ** 2))

    smooth, jolting = smallest(Joint()), smallest(Joint(extra=jolts))
    assert jolting["cogging"] == pytest.approx(smooth["cogging"], rel=0.2)
    for name in ("backlash", "pre_sliding", "elasticity"):
        assert jolting[name] > 1.5 * smooth[name]
