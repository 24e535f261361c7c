"""The examples of the catalogue: each effect shows, and shows as its equation says."""

import numpy as np
import pytest

from compensator.lab.effects.catalogue import catalogue
from compensator.lab.errors import UnknownEffectError
from compensator.lab.example import SHARE, example_of


@pytest.mark.parametrize("name", catalogue())
def test_every_effect_has_an_example_that_can_be_seen(name):
    found = example_of(name)
    effect = np.concatenate([one.effect for one in found.trials])
    without = np.concatenate([one.without for one in found.trials])
    assert np.sqrt(np.mean(effect**2)) == pytest.approx(SHARE * np.sqrt(np.mean(without**2)))
    for one in found.trials:
        assert np.isfinite(one.driver).all()
        assert len(one.time_s) == len(one.driver) == len(one.without) == len(one.effect)


def test_viscous_asymmetry_rises_with_speed_either_way():
    for one in example_of("viscous_asymmetry").trials:
        fast = np.abs(one.driver) > 0.5
        assert np.corrcoef(np.abs(one.driver[fast]), one.effect[fast])[0, 1] > 0.99
        assert (one.effect[fast] > 0).all()


def test_an_unknown_effect_is_refused():
    with pytest.raises(UnknownEffectError):
        example_of("moonlight")
