"""The law by which the share held of a drawn rig is judged, on numbers that can be counted by hand."""

import pytest

from bench.evaluation.figures.coverage import Share
from bench.evaluation.figures.measure import APART
from bench.evaluation.figures.trials import CALIBRATIONS
from tests.figures.intervals import chance_within, design_effect, is_within


def test_of_25_trials_one_or_two_may_be_missed():
    one, two = 25 * 0.05 * 0.95**24, 300 * 0.05**2 * 0.95**23
    assert chance_within(25) == pytest.approx(one + two)
    assert [is_within(Share(25 - missed, 25)) for missed in range(4)] == [False, True, True, False]


def test_misses_that_come_together_tell_as_much_as_fewer_trials():
    apart = [[Share(24, 25), Share(24, 25), Share(24, 25), Share(24, 25)]]
    together = [[Share(21, 25), Share(25, 25), Share(25, 25), Share(25, 25)]]
    assert design_effect(apart) == 0.0
    assert design_effect(together) == pytest.approx(4.0 / (25 * 0.04 * 0.96))


def test_no_two_drawn_rigs_have_a_seed_in_common():
    assert CALIBRATIONS <= APART
