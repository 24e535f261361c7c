"""What comes back with the position is told, whatever its order; what does not come back is not."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.left_over import orders
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.left_over import left_over
from compensator.lab.left_over.lines import is_peak
from compensator.lab.left_over.orders import FORCE, FRICTION, GROWING, Line, foretold_by_others, independent_of, line_of
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.gathering import gather
from tests.lab.left_over.judged import fitted
from tests.lab.synthetic import FACTS

ORDER = 43.7  # not in the catalogue, which has whole ones up to 30, and multiples of a gear ratio that is known
RIPPLE_N_M = 0.003  # a twentieth of the dry friction, half of the noise


def line(fit: Fit, most: float = PLAIN.line) -> Line | None:
    return line_of(gather(fit), most)


@pytest.mark.parametrize("seed", range(4))
def test_noise_does_not_come_back(seed):
    assert line(fitted(seed=seed)) is None


@pytest.mark.parametrize("seed", range(4))
def test_the_best_of_a_thousand_orders_is_no_small_chance(seed, monkeypatch):
    for bound, anything in (("VERY_STRONG", -np.inf), ("LEAST_OF_EFFORT", 0.0)):
        monkeypatch.setattr(orders, bound, anything)
    found = line(fitted(seed=seed), 1.0)
    assert found is not None
    assert found.chance > 0.01


def test_among_few_orders_none_is_a_peak():
    assert not is_peak(np.array([1.0, 3.0, 1.0])).any()


def test_a_ripple_smaller_than_a_sensor_is_linear_is_no_line(monkeypatch):
    fit = fitted(lambda x: RIPPLE_N_M * np.cos(ORDER * x.q + 0.4))
    found = line(fit)
    assert found is not None
    monkeypatch.setattr(orders, "LEAST_OF_EFFORT", 1.01 * found.share)
    assert line(fit) is None


def test_a_ripple_of_an_order_that_no_grid_has_is_named():
    told = replace(FACTS, gear_ratio=100.0)
    fit = fitted(lambda x: RIPPLE_N_M * np.cos(ORDER * x.q + 0.4), facts=told)
    found = line(fit)
    assert found is not None
    assert found.order == pytest.approx(ORDER, rel=0.02)
    assert found.kind == FORCE
    assert found.share == pytest.approx(RIPPLE_N_M / np.sqrt(2.0) / np.std(fit.dataset.effort), rel=0.5)
    answer = diagnose(fit)
    assert (answer.verdict, answer.candidates[0].effect.name) == ("missing", "cogging")
    assert answer.candidates[0].shape[0] == pytest.approx(ORDER, rel=0.02)


def test_a_line_does_not_hide_itself_in_the_noise_around():
    found = line(fitted(lambda x: 0.55 * RIPPLE_N_M * np.cos(ORDER * x.q + 0.4)), 2e-4)
    assert found is not None
    assert found.order == pytest.approx(ORDER, rel=0.02)


def test_friction_that_rises_and_falls_with_the_position_is_told_as_such():
    found = line(fitted(lambda x: RIPPLE_N_M * np.cos(ORDER * x.q) * np.sign(x.v)))
    assert found is not None
    assert found.order == pytest.approx(ORDER, rel=0.02)
    assert found.kind == FRICTION


def test_what_differs_along_the_path_but_does_not_come_back_is_no_line():
    random = np.random.default_rng(8)

    def extra(x):
        path = np.cumsum(np.abs(x.v)) * (x.time_s[1] - x.time_s[0])
        steps = random.standard_normal(int(path[-1] / 0.05) + 2)
        return 0.02 * 0.08 * np.interp(path, 0.05 * np.arange(len(steps)), steps) * np.sign(x.v)

    assert line(fitted(extra)) is None


def test_directions_that_are_alike_count_once():
    apart = np.eye(6)[:, :4]
    assert independent_of(apart) == pytest.approx(4.0)
    assert independent_of(np.repeat(apart[:, :1], 5, axis=1)) == pytest.approx(1.0)
    assert independent_of(apart * [1.0, 2.0, 3.0, 4.0]) == pytest.approx(4.0)
    assert independent_of(np.empty((6, 0))) == 0.0


def test_what_comes_in_one_stretch_alone_is_no_line(monkeypatch):
    """It may be of time as well as of position, however little chance has to do with it."""
    hit = iter([True])

    def extra(x):
        here = (x.time_s > 2.0) & (x.time_s < 4.0) & next(hit, False)
        return 0.02 * here * np.cos(ORDER * x.q)

    fit = fitted(extra)
    assert line(fit, 1.0) is None
    monkeypatch.setattr(orders, "VERY_STRONG", -np.inf)
    assert line(fit, 1.0) is not None


def test_cycles_of_a_linear_joint_are_counted_by_its_travel():
    fit = fitted(lambda x: 2.0 * RIPPLE_N_M * np.cos(ORDER * x.q))
    facts = replace(fit.dataset.facts, joint="linear")
    gathered = gather(fit)
    found = line_of(replace(gathered, fit=replace(fit, dataset=replace(fit.dataset, facts=facts))))
    assert found is not None
    assert found.order == pytest.approx(ORDER / (2.0 * np.pi), rel=0.02)


def test_an_order_that_only_the_slowest_rows_show_is_told():
    """Teeth and magnets go round so often that the filter takes them off all but the ends of strokes."""
    gathered = gather(fitted(lambda x: 8.0 * RIPPLE_N_M * np.cos(QUICK_ORDER * x.q)))
    speed = np.abs(gathered.fit.dataset.rows_of([one.motion.velocity for one in gathered.fit.dataset.trials]))
    assert QUICK_ORDER * np.quantile(speed[gathered.rows], 0.1) > 2.0 * np.pi * gathered.fit.dataset.cutoff_hz
    found = line_of(gathered)
    assert found is not None
    assert found.order == pytest.approx(QUICK_ORDER, rel=0.02)


QUICK_ORDER = 250.3
SLOW_ORDER = 9.3  # that the filter passes in fast motion, too


MISREAD_ORDER = 20.7


def test_what_grows_with_the_speed_is_told_though_no_force_would_be():
    """An angle that is misread round and round seems to be accelerated so, and may have no name in the catalogue."""
    fit = fitted(lambda x: 0.5 * RIPPLE_N_M * x.v**2 * np.cos(MISREAD_ORDER * x.q + 0.4))
    assert line_of(gather(fit), most_growing=0.0) is None
    found = left_over(gather(fit)).line
    assert found is not None
    assert found.kind == GROWING
    assert found.order == pytest.approx(MISREAD_ORDER, rel=0.05)


def growing_line(law):
    """What of a ripple of some law grows with the square of the speed, at any order."""
    return line_of(gather(fitted(lambda x: law(x) * np.cos(SLOW_ORDER * x.q + 0.4))), most=0.0)


def test_an_acceleration_that_goes_round_grows_with_the_speed():
    found = growing_line(lambda x: 2.0 * RIPPLE_N_M * x.v**2)
    assert found is not None
    assert found.kind == GROWING
    assert found.order == pytest.approx(SLOW_ORDER, rel=0.1)


@pytest.mark.parametrize("law", [lambda x: 4.0 * RIPPLE_N_M, lambda x: 4.0 * RIPPLE_N_M * np.sign(x.v), lambda x: 0.0])
def test_neither_a_force_nor_friction_nor_noise_grows_with_the_speed(law):
    assert growing_line(law) is None


STRETCH = np.repeat(np.arange(5), (40, 40, 40, 40, 400))
COLUMN = np.random.default_rng(1).standard_normal((len(STRETCH), 1))


def test_what_is_in_all_stretches_is_foretold_but_for_the_best_one():
    coefficients, foretold = foretold_by_others(COLUMN, COLUMN[:, 0], STRETCH)
    assert coefficients == pytest.approx([1.0])
    assert foretold == pytest.approx(np.sum(COLUMN[STRETCH < 4] ** 2))


@pytest.mark.parametrize("where", [0, 4])
def test_what_is_in_one_stretch_alone_is_not(where):
    assert foretold_by_others(COLUMN, (where == STRETCH) * COLUMN[:, 0], STRETCH)[1] <= 0.0
