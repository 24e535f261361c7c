"""A formula is held against a curve with what it leaves open; what is no such formula is unknown."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from compensator.lab.diagnosis import confirmation, unfollowed
from compensator.lab.diagnosis.confirmation import LEAST_GAIN_OF_CHAIN
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.search import search
from compensator.lab.diagnosis.wording import driver_in_words
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.diagnosis.test_diagnose import load_n_m
from tests.lab.synthetic import FACTS, Joint, Law, Truth, recordings


def fit_to(law: Law, seed: int = 5) -> Fit:
    made = recordings(Joint(extra=law), seed=seed)
    return fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS))


def of_load(friction: Callable[[np.ndarray], np.ndarray]) -> Law:
    return lambda x: friction(load_n_m(x)) * np.sign(x.v)


def carried(x: Truth) -> np.ndarray:
    """A spring, and teeth that lose 30 % of what they carry, of the spring's torque, too."""
    spring = 0.15 * (x.q - 0.8)
    return spring + 0.3 * np.abs(load_n_m(x) + spring) * np.sign(x.v)


def test_friction_of_a_load_without_the_spring_that_is_missing_too_is_named_and_so_is_the_spring():
    found = search(fit_to(carried, seed=6))
    assert [step.effect for step in found.steps] == ["load_friction", "spring"]
    assert (found.last.verdict, found.last.remains) == ("nothing", False)


@pytest.mark.parametrize(
    "friction",
    [lambda load: 0.3 * np.minimum(np.abs(load), 0.3), lambda load: 0.2 * np.maximum(load, 0.0)],
    ids=["that comes to an end", "of one flank"],
)
def test_friction_of_the_load_of_another_form_is_unknown(friction):
    found = diagnose(fit_to(of_load(friction)))
    assert found.verdict == "unknown-effect", found.sentence
    assert found.driver == "load against motion"
    steady = [one for one in found.candidates if one.rows == "sliding" and not one.effect.pipeline]
    assert all("does not follow the curve over load" in one.refused for one in steady)
    # friction that goes by the weight of one flank goes round twice a turn, too: that formula comes as near
    assert "load_friction" in [one.effect.name for one in found.candidates]


@pytest.mark.parametrize(("gain", "low", "unknown"), [(0.9, 0.01, False), (1.1, 0.01, True), (1.1, -0.01, False)])
def test_a_curve_is_of_use_on_other_trials_for_sure_or_no_unknown_effect(monkeypatch, gain, low, unknown):
    fit = fit_to(lambda x: 0.05 * np.exp(-(((x.q - 0.4) / 0.08) ** 2)) * np.sign(x.v))
    monkeypatch.setattr(confirmation, "held_out_gain", lambda *_: Gain(gain * LEAST_GAIN_OF_CHAIN, low, 0.1))
    assert (diagnose(fit).verdict == "unknown-effect") == unknown


@pytest.mark.parametrize(
    ("confirmed", "share", "helps", "follows"),
    [
        (True, 0.7, True, True),
        (True, 0.5, True, False),
        (True, 0.5, False, True),
        (False, 0.7, False, False),
    ],
)
def test_a_formula_follows_a_curve_by_its_evidence_or_by_what_is_left_to_the_curve(
    monkeypatch, confirmed, share, helps, follows
):
    monkeypatch.setattr(unfollowed, "is_confirmed", lambda _: confirmed)
    monkeypatch.setattr(unfollowed, "held_out", lambda _: None)
    monkeypatch.setattr(unfollowed, "is_helpful", lambda *_: helps)
    one = SimpleNamespace(evidence=SimpleNamespace(noncentrality=share), explained=object())
    assert unfollowed._follows(one, SimpleNamespace(noncentrality=1.0), None) == follows


@pytest.mark.parametrize(
    ("driver", "told"),
    [
        ("velocity against motion", "speed against motion"),
        ("velocity", "speed with its sign"),
        ("load against motion", "load against motion"),
    ],
)
def test_a_velocity_is_a_speed_as_on_the_page(driver, told):
    assert driver_in_words(driver) == told
