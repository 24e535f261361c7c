"""Two rivals on normal equations that are written down: d' by its formula, and the sizes that rows allow."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.next_trial.rivalry import Equations, Rival, Rivalry

ROWS, NOISE_POWER = 1000, 0.04
FREE = [(-np.inf, np.inf)]


class Written(Rivalry):
    """A model of one column, no measuring chain, two rivals of one column each."""

    def __init__(self, gram, inflation=1.0):
        first, second = (effect_named(name) for name in ("viscous_quadratic", "spring"))
        self.rivals = [Rival(first, (), np.array([0.5]), ((),)), Rival(second, (), np.array([0.2]), ((),))]
        self.suspects, self.noise_power, self.measured = 2, NOISE_POWER, Equations(ROWS, np.array(gram))
        self._inflation, self._nuisance, self._model, self._stretches = [inflation] * 2, (), 1, 50

    @property
    def dataset(self):
        raise NotImplementedError

    def of_trials(self, dataset):
        raise NotImplementedError

    @staticmethod
    def _stands_in(rival):
        return frozenset()


def sized(rivalry):
    candidates: Any = [SimpleNamespace(score=9.0)] * 2
    return rivalry._sized(candidates, [FREE, FREE])[0]


@pytest.mark.parametrize("inflation", [1.0, 4.0])
def test_sizes_scatter_by_the_error_of_rows_that_are_not_independent(inflation):
    found = sized(Written([[900.0, 300.0, 0.0], [300.0, 500.0, 0.0], [0.0, 0.0, 100.0]], inflation)).sizes
    error = np.sqrt(inflation * NOISE_POWER / (500.0 - 300.0**2 / 900.0))
    assert found.mean() == pytest.approx(0.5, abs=1e-6)
    assert found.std() == pytest.approx(error, rel=0.03)


@pytest.mark.parametrize("inflation", [1.0, 4.0])
def test_d_prime_is_what_the_rival_cannot_make_of_the_evidence(inflation):
    rivalry = Written([[900.0, 0.0, 0.0], [0.0, 500.0, 60.0], [0.0, 60.0, 100.0]], inflation)
    power = 0.5**2 * 500.0
    evidence = ROWS / inflation * np.log1p(power / (ROWS * NOISE_POWER))
    left = 1.0 - 60.0**2 / (500.0 * 100.0)
    assert rivalry.d_prime(rivalry.measured, 0, None) == pytest.approx(np.sqrt(evidence))
    assert rivalry.d_prime(rivalry.measured, 0, 1) == pytest.approx(np.sqrt(evidence * left))
