"""A small effect beside a formula that is nearly right: its gain is judged as evidence is, beside what that leaves."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from compensator.lab.diagnosis import examination
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import BesideOpen, Candidate
from compensator.lab.diagnosis.families import _chance_of
from compensator.lab.diagnosis.second_look import beside_open
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import gather_curves
from tests.lab.screening.test_discrepancy import fitted
from tests.lab.synthetic import Joint, Truth

WEIGHT = "weight_friction"
ASYMMETRY = "viscous_asymmetry"


def law(asymmetry: float) -> Joint:
    """Weight that changes all of dry friction, where its formula changes Coulomb friction alone; and an asymmetry."""

    def extra(x: Truth) -> np.ndarray:
        dry = 0.08 + 0.08 * np.exp(-np.abs(x.v) / 0.25)
        return 15.0 * x.load_kg * dry * np.sign(x.v) + asymmetry * np.abs(x.v)

    return Joint(static_excess=0.08, extra=extra)


def test_a_gain_that_another_formula_hides_shows_beside_what_that_leaves_open():
    fit = fitted(law(0.002), WEIGHT)
    after = fit_effects(fit.dataset, [*fit.names, ASYMMETRY], fit.training)
    found = beside_open(gather_curves(fit).fit, [ASYMMETRY], held_out)
    assert held_out_gain(held_out(fit), held_out(after)).low < 0.0
    assert found[ASYMMETRY].gain.low > 0.15
    assert found[ASYMMETRY].after < 0.8 * found[ASYMMETRY].before


def test_what_another_formula_hides_is_named_and_nothing_is_where_nothing_is():
    named = diagnose(fitted(law(0.0007), WEIGHT))
    assert (named.verdict, named.classes[0]) == ("missing", (ASYMMETRY,)), named.sentence
    assert named.candidates[0].beside_open is not None
    assert "beside what the model's formulas leave open" in named.sentence
    assert diagnose(fitted(law(0.0), WEIGHT)).verdict == "nothing"


def test_a_model_whose_formulas_leave_nothing_open_is_looked_at_once():
    fit = fitted(Joint())
    assert beside_open(gather_curves(fit).fit, [ASYMMETRY], held_out) == {}


def candidate(name: str, gain: Gain, physical: bool = True) -> Candidate:
    """With evidence that is very strong, and no luck."""
    effect = effect_named(name)
    return Candidate(effect, (), 50.0, 1e-6, 9.0, (), 0.1, 0.08, gain, physical, None, effect.rows)


def evidence(noncentrality: float) -> Any:
    return SimpleNamespace(noncentrality=noncentrality)


@pytest.mark.parametrize(
    ("noncentrality", "again"),
    [(200.0, False), (121.0, False), (119.0, True)],  # the last one is what is left of it when the other's shadow
)
def test_where_one_is_confirmed_that_is_no_shadow_no_other_is_looked_at_again(monkeypatch, noncentrality, again):
    better = BesideOpen(0.1, 0.05, Gain(0.5, 0.4, 0.6))
    monkeypatch.setattr(examination, "beside_open", lambda _fit, names, _held_out: dict.fromkeys(names, better))
    confirmed, hidden = candidate("cogging", Gain(0.3, 0.2, 0.4)), candidate(ASYMMETRY, Gain(-0.1, -0.2, 0.1))
    gathered: Any = SimpleNamespace(show_in="sliding", fit=None)
    found = examination._looked_at_again(gathered, [confirmed, hidden], [evidence(noncentrality), evidence(200.0)])
    assert [one.beside_open for one in found] == [None, better if again else None]


DRAWN = (0.3, -0.1, 0.5)  # a gain that trials drawn again are not sure of
SURE = (0.3, 0.2, 0.4)


@pytest.mark.parametrize(
    ("name", "physical", "possible", "anew", "shape", "at_bound", "confirmed"),
    [
        ("backlash", True, True, SURE, (0.01,), False, True),
        ("backlash", True, True, DRAWN, (0.01,), False, False),  # no better in the model that would be had
        ("backlash", False, True, SURE, (0.01,), False, False),  # it cannot be it
        ("elasticity", False, True, SURE, (8.0, 0.3), False, True),  # past the scan, but it swings once it is fitted
        ("elasticity", False, True, SURE, (8.0, 0.6), False, False),  # it does not swing
        ("elasticity", False, True, SURE, (8.0, 0.3), True, False),  # of a share of the load that cannot be
        ("elasticity", False, False, SURE, (8.0, 0.3), False, False),
    ],
)
def test_near_reversals_the_second_look_is_at_the_model_that_would_be_had(
    monkeypatch, name, physical, possible, anew, shape, at_bound, confirmed
):
    term = SimpleNamespace(effect=effect_named(name), shape=shape, at_bound=np.array([at_bound]))
    monkeypatch.setattr(examination, "fit_effects", lambda *_: SimpleNamespace(terms=[term]))
    monkeypatch.setattr(examination, "as_in_the_ladder", lambda one, *_: replace(one, gain=Gain(*anew)))
    monkeypatch.setattr(examination, "is_possible", lambda *_: possible)
    fit = SimpleNamespace(dataset=None, names=("coulomb",), training=None)
    gathered: Any = SimpleNamespace(show_in="moving", fit=fit)
    first = candidate(name, Gain(*DRAWN), physical)
    [found] = examination._looked_at_again(gathered, [first], [evidence(200.0)])
    assert (examination.is_confirmed(found), found.anew, found.looks) == (confirmed, confirmed, 1 + confirmed)
    if not confirmed:
        assert found is first


def test_two_looks_at_a_gain_are_paid_for():
    screening: Any = SimpleNamespace(chance_of=lambda _name: 1e-4)
    first = candidate(ASYMMETRY, Gain(*SURE))
    beside = BesideOpen(0.1, 0.05, Gain(*SURE))
    once, *twice = (
        _chance_of(screening, one) for one in (first, replace(first, beside_open=beside), replace(first, anew=True))
    )
    assert twice == pytest.approx([2.0 * once] * 2)
    assert once >= 1e-4
