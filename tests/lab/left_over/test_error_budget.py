"""Questions about what a model leaves share one budget, and each asks for its own part of it."""

from dataclasses import fields
from inspect import signature

import numpy as np
import pytest

from compensator.lab.left_over import left_over, swinging
from compensator.lab.left_over.error_budget import PLAIN, WANDERING_BESIDE_A_NAME
from compensator.lab.left_over.orders import line_of
from compensator.lab.left_over.wandering import wandering_of
from compensator.lab.model.fit import fit_model
from compensator.lab.screening.gathering import gather, gather_curves
from tests.lab.left_over.judged import fitted
from tests.lab.synthetic import Joint, Law

MOST = 0.01  # of complete models
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
    assert sum(parts) + PLAIN.wandering <= MOST  # wandering is asked twice: of dry friction, and of a constant force


def test_each_question_has_its_own_part(monkeypatch):
    asked = []
    monkeypatch.setattr(swinging, "_line", lambda *_, of_voltage, most: asked.append((of_voltage, most)))
    gathered = gather_curves(fitted())
    swinging.swing_of(gathered)
    swinging.ripple_of(gathered)
    assert asked == [(False, PLAIN.swing), (True, PLAIN.ripple)]
    for question, part in ((line_of, PLAIN.line), (wandering_of, PLAIN.wandering)):
        assert signature(question).parameters["most"].default == part
    assert signature(line_of).parameters["most_growing"].default == PLAIN.growing


@pytest.mark.parametrize(("more", "chance"), [([], PLAIN.wandering), (["spring"], WANDERING_BESIDE_A_NAME)])
def test_what_a_further_formula_leaves_must_wander_more_surely(more, chance, monkeypatch):
    asked = []
    monkeypatch.setattr(left_over, "wandering_of", lambda *given: asked.append(given[1]))
    fit = fitted()
    left_over.left_over(gather(fit_model(fit.dataset, [*fit.names, *more])))
    assert asked == [chance]
    assert PLAIN.wandering > WANDERING_BESIDE_A_NAME


@pytest.mark.parametrize("seed", [5, 7])
def test_a_surface_that_is_a_little_rough_is_no_alarm(seed):
    assert line_of(gather(fitted(rough(seed), seed))) is None


def test_the_line_of_a_rough_surface_is_one_that_chance_brings():
    """What is of the path comes again in every stretch: the orders around one are alike, and tell less of the noise."""
    gathered = gather(fitted(rough(7), 7))
    found = line_of(gathered, most=1.0)
    assert found is None or found.chance > 1e-3
