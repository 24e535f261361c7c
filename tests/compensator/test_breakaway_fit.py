"""I_load and F_load from several breakaways at two rates."""

from math import isnan

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.rest.breakaway_fit import Breakaway, fit

RATES = (0.6, 0.15)


def let_go(load_a, friction_a, delay, pairs=4, scatter_a=0.0, generator=None, rates=RATES):
    found = []
    for pair in range(pairs):
        for sign in (1.0, -1.0):
            rate = rates[pair % len(rates)]
            noise_a = scatter_a * generator.standard_normal() if generator else 0.0
            found.append(Breakaway(sign, load_a + sign * (friction_a + delay * rate ** (2 / 3)) + noise_a, rate))
    return found


def test_two_rates_tell_what_the_ramp_gained():
    found = fit(let_go(0.5, 0.3, 0.04))
    assert found.load_current_a.value == pytest.approx(0.5)
    assert found.friction_current_a.value == pytest.approx(0.3)
    assert found.delay == pytest.approx(0.04)


def test_one_rate_leaves_it_in_the_friction():
    found = fit(let_go(0.5, 0.3, 0.04, rates=(0.6,)))
    assert found.load_current_a.value == pytest.approx(0.5)
    assert found.friction_current_a.value == pytest.approx(0.3 + 0.04 * 0.6 ** (2 / 3))
    assert found.delay == 0.0


def test_one_breakaway_each_way_is_eqs_9_and_10_without_an_interval():
    found = fit([Breakaway(1.0, 0.8, 0.2), Breakaway(-1.0, 0.2, 0.2)])
    assert found.load_current_a.value == pytest.approx(0.5)
    assert found.friction_current_a.value == pytest.approx(0.3)
    assert isnan(found.load_current_a.low)
    assert isnan(found.scatter_a)


@pytest.mark.parametrize("pairs", [2, 4])
def test_the_intervals_hold_the_truth_as_often_as_they_say(pairs):
    generator = np.random.default_rng(11)
    trials, load, friction = 3000, 0, 0
    for _ in range(trials):
        found = fit(let_go(0.5, 0.3, 0.04, pairs, 0.004, generator))
        load += found.load_current_a.low <= 0.5 <= found.load_current_a.high
        friction += found.friction_current_a.low <= 0.3 <= found.friction_current_a.high
    # 95 % of 3000, three standard deviations of the count
    for held in (load, friction):
        assert abs(held / trials - 0.95) < 3.0 * (0.95 * 0.05 / trials) ** 0.5


def test_the_variances_are_those_of_the_two_currents():
    generator = np.random.default_rng(5)
    fits = [fit(let_go(0.5, 0.3, 0.04, 4, 0.004, generator)) for _ in range(1500)]
    load_a = np.std([one.load_current_a.value for one in fits])
    friction_a = np.std([one.friction_current_a.value for one in fits])
    assert load_a == pytest.approx(0.004 * fits[0].load_variance ** 0.5, rel=0.06)
    assert friction_a == pytest.approx(0.004 * fits[0].friction_variance ** 0.5, rel=0.06)


@pytest.mark.parametrize("few", [[], [Breakaway(1.0, 0.5, 0.1)], [Breakaway(1.0, 0.5, 0.1), Breakaway(1.0, 0.6, 0.1)]])
def test_too_few_are_refused(few):
    with pytest.raises(ModelParameterError, match="both ways"):
        fit(few)
