"""What a model leaves: more than noise, or not."""

import re

import numpy as np
import pytest

from compensator.lab.assembly import make_dataset
from compensator.lab.catalogue import default_effects
from compensator.lab.dataset import Processing
from compensator.lab.diagnose import diagnose
from compensator.lab.fit import fit_model
from compensator.lab.remainder import remainder_of
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


def fitted(extra=None, seed=0, **bench):
    made = recordings(Joint(extra=extra), Bench(**{"duration_s": 9.0, "noise_memory": 0.0, **bench}), plans(), seed)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


def left(fit):
    return remainder_of(fit.dataset, fit.residual[fit.training], fit.training)


def ripple(x):
    return 0.05 * np.sin(2.0 * np.pi * 3.1 * x.time_s)


@pytest.mark.parametrize("seed", range(4))
def test_of_a_complete_model_noise_is_left(seed):
    found = left(fitted(seed=seed))
    assert found.over_noise == pytest.approx(1.0, abs=0.35)
    assert not found.is_more_than_noise


def test_coloured_noise_is_more_than_expected_but_has_no_shape():
    found = left(fitted(noise_memory=0.8))
    assert found.over_noise > 1.5
    assert not found.is_more_than_noise


def test_a_ripple_is_told_with_its_frequency():
    fit = fitted(ripple)
    found = left(fit)
    assert found.is_more_than_noise
    assert found.frequency_hz == pytest.approx(3.1, rel=0.1)
    answer = diagnose(fit)
    assert re.match(r"No effect of the catalogue is confirmed \(p = [\d.e-]+\), yet", answer.sentence)
    assert re.search(r"swings at about (2\.[89]|3(\.[0-4])?) Hz", answer.sentence)
    assert "times the effort's own noise" in answer.sentence


def test_friction_that_jumps_is_not_called_nothing():
    random = np.random.default_rng(3)

    def jumps(x):
        at_s, size = random.uniform(2.0, 6.0), random.choice([-0.05, 0.05])
        return size * (x.time_s > at_s) * np.sign(x.v)

    fit = fitted(jumps)
    assert left(fit).is_more_than_noise
    assert "Nothing is missing" not in diagnose(fit).sentence
