"""What cosine and sine explain is what least squares makes of the two; an order that nobody tells is found."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.linear import orthonormal
from compensator.lab.model.order_search import Path, explained
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

ROWS, PAIRS = 90, 6
ORDER = 61.3  # of a wheel between motor and joint, or once a turn of a motor whose gear nobody tells
RIPPLE_N_M = 0.015


def test_it_is_the_fall_of_the_squares():
    random = np.random.default_rng(1)
    basis = orthonormal(random.standard_normal((ROWS, 4)))
    columns = random.standard_normal((ROWS, 2 * PAIRS)) + basis[:, :1]
    residual = random.standard_normal(ROWS)
    residual -= basis @ (basis.T @ residual)
    found = explained(columns, basis, residual)
    for index in range(PAIRS):
        pair = np.column_stack([basis, columns[:, [index, PAIRS + index]]])
        left = residual - pair @ np.linalg.lstsq(pair, residual, rcond=None)[0]
        assert found[index] == pytest.approx(residual @ residual - left @ left)


def test_two_that_are_one_beside_the_model_explain_nothing():
    random = np.random.default_rng(2)
    basis = orthonormal(random.standard_normal((ROWS, 2)))
    cosine = random.standard_normal(ROWS)
    found = explained(np.column_stack([cosine, 2.0 * cosine + basis[:, 0]]), basis, random.standard_normal(ROWS))
    assert found == pytest.approx([0.0])


def test_what_is_not_told_from_the_model_explains_nothing():
    random = np.random.default_rng(3)
    basis = orthonormal(random.standard_normal((ROWS, 2)))
    hidden = basis[:, 0] + 1e-3 * random.standard_normal(ROWS)
    found = explained(np.column_stack([hidden, random.standard_normal(ROWS)]), basis, random.standard_normal(ROWS))
    assert found == pytest.approx([0.0])


def path_of(position, speed) -> Path:
    return Path(position, speed, np.ones(len(position)), np.ones(len(position)), cutoff_rad_s=30.0)


def test_the_highest_order_is_one_that_enough_of_the_travel_was_slow_enough_for():
    """Where a joint turns back every order passes the filter, over a part of one wave."""
    phase = np.linspace(0.0, 4.0 * np.pi, 2000)
    steady = path_of(np.linspace(-1.0, 1.0, 2000), np.full(2000, 0.5))
    swung = path_of(np.sin(phase), 2.0 * np.abs(np.cos(phase)))
    assert steady.highest == pytest.approx(30.0 / 0.5)
    assert swung.highest == pytest.approx(30.0 / (2.0 * np.sqrt(1.0 - 0.92**2)), rel=0.02)  # a twentieth at either end
    assert swung.orders.max() <= swung.highest
    grid = [(3.0,), (20.0,), (300.0,)]
    assert swung.shown(grid) == [(3.0,), (20.0,)]
    assert swung.shown([(300.0,), (200.0,)]) == [(200.0,)]


def fitted(law, facts=FACTS, effects=()):
    made = recordings(Joint(extra=law), Bench(duration_s=6.0), plans(), seed=2)
    return fit_model(make_dataset(made, facts, Processing(cutoff_hz=8.0)), [*default_effects(facts), *effects])


LAWS = {
    "position_periodic_friction": lambda x: RIPPLE_N_M * np.cos(ORDER * x.q + 0.4) * np.sign(x.v),
    "cogging": lambda x: RIPPLE_N_M * np.cos(ORDER * x.q + 0.4),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("ratio", [None, 100.0])
def test_what_goes_round_so_often_is_named_whatever_the_gear_ratio(name, ratio):
    fit = fitted(LAWS[name], replace(FACTS, gear_ratio=ratio))
    found = diagnose(fit)
    assert (found.verdict, found.candidates[0].effect.name) == ("missing", name), found.sentence
    assert found.candidates[0].shape[0] == pytest.approx(ORDER, rel=0.01)
    grown = fit_model(fit.dataset, [*fit.names, name])
    assert grown.shapes[name][0] == pytest.approx(ORDER, rel=0.01)
    assert np.hypot(*grown.terms[-1].coefficients) == pytest.approx(RIPPLE_N_M, rel=0.1)


def test_an_order_of_the_grid_stays_where_none_beside_it_is_worth_the_tries():
    fit = fitted(lambda x: RIPPLE_N_M * np.cos(12.0 * x.q + 0.4))
    assert fit_model(fit.dataset, [*fit.names, "cogging"]).shapes["cogging"] == (12.0,)


def test_an_order_that_hardly_shows_is_neither_judged_nor_fitted(monkeypatch):
    fit = fitted(lambda x: RIPPLE_N_M * np.cos(20.0 * x.q), replace(FACTS, gear_ratio=100.0))
    assert fit_model(fit.dataset, [*fit.names, "cogging"]).shapes["cogging"] == (20.0,)
    monkeypatch.setattr(Path, "highest", 12.0)
    judged = [block.shape[0] for block in gather(fit).named if block.name == "cogging"]
    assert max(judged) == 12.0
    assert fit_model(fit.dataset, [*fit.names, "cogging"]).shapes["cogging"][0] <= 12.0
