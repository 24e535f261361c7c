"""Questions about what a model leaves share one budget, and each asks for its own part of it."""

from dataclasses import fields
from inspect import signature

import numpy as np
import pytest

from compensator.lab.left_over import constancy, left_over, ripple, swinging
from compensator.lab.left_over.error_budget import MOST, NAMED, PLAIN
from compensator.lab.left_over.following import following_of
from compensator.lab.left_over.orders import growing_line_of, line_of
from compensator.lab.left_over.wandering import wandering_of
from compensator.lab.model.fit import fit_model
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.left_over.judged import fitted, white_rows_of
from tests.lab.synthetic import Joint, Law

ROUGH = 0.02  # of Coulomb friction, root mean square
LENGTH_RAD = 0.05  # over which it is alike


def rough(seed: int) -> Law:
    """Dry friction that is not quite the same along its path, as no surface is: every order has a little of it."""
    orders = np.arange(2, 60)
    parts = np.random.default_rng(seed).standard_normal((2, len(orders))) / np.hypot(1.0, LENGTH_RAD * orders)
    parts *= ROUGH * Joint().coulomb / np.sqrt(0.5 * np.sum(parts**2))

    def law(x):
        phase = np.multiply.outer(x.q, orders)
        return np.sign(x.v) * (np.cos(phase) @ parts[0] + np.sin(phase) @ parts[1])

    return law


def test_a_complete_model_is_not_alarmed_about_more_often_than_the_budget_says():
    parts = [getattr(PLAIN, one.name) for one in fields(PLAIN)]
    assert all(part > 0.0 for part in parts)
    assert sum(parts) < PLAIN.whole <= MOST


def test_each_question_has_its_own_part():
    assert (PLAIN.change, PLAIN.swing, PLAIN.ripple) == (constancy.CHANCE, swinging.CHANCE, ripple.CHANCE)
    for question, part in ((line_of, PLAIN.line), (following_of, PLAIN.following), (wandering_of, PLAIN.wandering)):
        assert signature(question).parameters["most"].default == part


@pytest.mark.parametrize(("more", "budget"), [([], PLAIN), (["spring"], NAMED)])
def test_what_a_further_formula_leaves_must_wander_more_surely(more, budget, monkeypatch):
    asked = []
    monkeypatch.setattr(left_over, "wandering_of", lambda *given: asked.append(given[1]))
    fit = fitted()
    left_over.left_over(gather(fit_model(fit.dataset, [*fit.names, *more])))
    assert asked == [budget.wandering]
    assert NAMED.wandering < PLAIN.wandering


@pytest.mark.parametrize("seed", [5, 7])
def test_a_surface_that_is_a_little_rough_is_no_alarm(seed):
    """Where it may be told by a chance of 1 in 1,000 it is one: what is of the path comes again in every stretch."""
    gathered = with_noise(gather(fitted(rough(seed), seed)))
    white = white_rows_of(gathered)
    assert line_of(gathered, white) is None
    assert growing_line_of(gathered, white, PLAIN.growing) is None
    assert following_of(gathered, white) is None
    assert line_of(gathered, white, most=1e-3) is not None  # else this test shows nothing
