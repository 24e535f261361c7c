"""Units of one kind: mean, scatter and outliers, against hand calculation and against draws whose truth is known."""

import numpy as np
import pytest
from scipy.stats import binom
from scipy.stats import t as student

from compensator.lab.units.outliers import corrected_by_holm, deviations
from compensator.lab.units.random_effects import UnitValues, chance_of_one_value, common_of
from tests.lab.units.drawn import drawn


def exact(values: list[float], error: float = 1e-6) -> UnitValues:
    count = len(values)
    return UnitValues(np.array(values), np.full(count, error), np.full(count, 8.0))


def test_with_values_known_exactly_it_is_students_interval():
    values = [1.0, 1.2, 0.9, 1.4]
    found = common_of(exact(values))
    half = student.ppf(0.975, 3) * np.std(values, ddof=1) / 2.0
    assert (found.value, found.low, found.high) == pytest.approx((1.125, 1.125 - half, 1.125 + half))
    assert found.scatter == pytest.approx(np.std(values, ddof=1))
    assert found.next_high - found.value == pytest.approx(half * np.sqrt(5.0))


def test_what_errors_explain_is_no_scatter():
    found = common_of(exact([1.0, 1.1, 0.9, 1.05], error=0.2))
    assert (found.scatter, found.scatter_low) == (0.0, 0.0)
    assert found.scatter_high > 0.0
    assert found.high - found.value == pytest.approx(student.ppf(0.975, 3) * 0.1)  # of the errors, not of the luck


def test_a_deviation_is_the_deleted_students_residual():
    values = [1.0, 1.2, 0.9, 1.4, 3.0]
    ((*_, last),) = deviations([exact(values)])
    others = np.array(values[:-1])
    t = (3.0 - others.mean()) / (others.std(ddof=1) * np.sqrt(1.25))
    assert last.chance == pytest.approx(2.0 * student.sf(t, 3), rel=1e-6)
    assert last.corrected == pytest.approx(min(1.0, 5.0 * last.chance))
    assert last.by == pytest.approx(3.0 - others.mean())


def test_holm_corrects_by_rank_and_keeps_the_order():
    assert corrected_by_holm([0.02, 0.001, 0.03, 0.5], 4) == pytest.approx([0.06, 0.004, 0.06, 0.5])


def test_chances_of_units_that_are_no_outliers_are_corrected_for_all_quantities():
    random = np.random.default_rng(11)
    found = [one for quantity in deviations(_five(random, 6, 0.05)) for one in quantity]
    assert not any(one.is_outlier for one in found)
    assert [one.corrected for one in found] == pytest.approx(corrected_by_holm([one.chance for one in found], 30))


def test_two_outliers_do_not_hide_each_other_where_there_are_enough_others():
    random = np.random.default_rng(3)
    values = drawn(random, 12, 0.05, 0.01, 9)
    values.value[4] += 0.9
    values.value[7] += 0.6
    (found,) = deviations([values])
    assert [number for number, one in enumerate(found) if one.is_outlier] == [4, 7]
    assert found[7].low < 0.6 < found[7].high


def test_of_three_units_none_is_an_outlier_but_all_have_a_deviation():
    (found,) = deviations([exact([1.0, 1.0001, 9.0])])
    assert not any(one.is_outlier for one in found)
    assert found[2].by == pytest.approx(8.0, rel=1e-3)


def test_an_outlier_of_a_unit_with_a_large_error_is_none():
    values = drawn(np.random.default_rng(5), 8, 0.05, 0.01, 9)
    values.value[2] += 0.5
    values.error[2] = 0.4
    (found,) = deviations([values])
    assert not any(one.is_outlier for one in found)


@pytest.mark.parametrize("units", [4, 10])
@pytest.mark.parametrize("scatter", [0.0, 0.05, 0.5])
def test_false_alarms_are_as_rare_as_claimed(units, scatter):
    """Five quantities of units that are all of one kind: an outlier in any of them is a false alarm."""
    random = np.random.default_rng(units)
    sets = 100
    alarms = sum(
        any(one.is_outlier for found in deviations(_five(random, units, scatter)) for one in found) for _ in range(sets)
    )
    assert alarms <= binom.ppf(0.999, sets, 0.05)


def _five(random: np.random.Generator, units: int, scatter: float) -> list[UnitValues]:
    return [drawn(random, units, scatter, 0.05, 7) for _ in range(5)]


@pytest.mark.parametrize(("scatter", "units"), [(0.05, 5), (0.05, 12), (0.3, 5), (0.3, 12)])
def test_intervals_hold_the_truth_as_often_as_they_say(scatter, units):
    random = np.random.default_rng(17)
    sets, held = 200, np.zeros(3)
    for _ in range(sets):
        found = common_of(drawn(random, units, scatter, 0.05, 9))
        another = drawn(random, 1, scatter, 0.05, 9).value[0]
        held += [
            found.low <= 1.0 <= found.high,
            found.scatter_low <= scatter <= found.scatter_high,
            found.next_low <= another <= found.next_high,
        ]
    assert np.all(held >= binom.ppf(0.001, sets, 0.95)), held / sets


def test_one_and_the_same_value_is_denied_as_rarely_as_claimed():
    random = np.random.default_rng(23)
    chances = np.array([chance_of_one_value(drawn(random, 6, 0.0, 0.05, 6)) for _ in range(600)])
    assert binom.ppf(0.001, 600, 0.05) <= np.sum(chances < 0.05) <= binom.ppf(0.999, 600, 0.06)
    apart = [chance_of_one_value(drawn(random, 6, 0.2, 0.05, 6)) for _ in range(20)]
    assert np.median(apart) < 0.01
