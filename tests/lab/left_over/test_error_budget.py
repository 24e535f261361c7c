"""Questions about what a model leaves share one budget, and each asks for its own part of it."""

from dataclasses import fields
from inspect import signature

import pytest

from compensator.lab.left_over import constancy, left_over, ripple, swinging
from compensator.lab.left_over.error_budget import MOST, NAMED, PLAIN
from compensator.lab.left_over.following import following_of
from compensator.lab.left_over.orders import line_of
from compensator.lab.left_over.wandering import wandering_of
from compensator.lab.model.fit import fit_model
from compensator.lab.screening.candidates import gather
from tests.lab.left_over.judged import fitted


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
