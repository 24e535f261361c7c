"""What bends along with the joint and slides is none of the catalogue, whatever formula imitates a part of it."""

from functools import cache

import numpy as np
import pytest

from compensator.lab.diagnosis import confirmation, unfollowed
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.diagnosis.four_families import judged
from compensator.lab.diagnosis.unfollowed import provisional
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.generic import free_curves
from tests.lab.diagnosis.test_slow_turns import fitted as turns_one_way
from tests.lab.synthetic import FACTS, Joint, Law, recordings

DEFAULT = default_effects(FACTS)
FORCE_N_M, STIFFNESS_1_RAD = 0.012, 6.0
WEAK = 0.25  # of it: no luck, and of use


def hose(x) -> np.ndarray:
    """Torque [N m] after Bouc and Wen: dz = (1 - |z|^1.5 (1 + sgn(z dq)) / 2) k dq, no sum of sliders."""
    bent, found = 0.0, np.empty(len(x.q))
    for index, turn in enumerate(np.diff(x.q, prepend=x.q[0])):
        along = 0.5 * (1.0 + np.sign(bent * turn))
        bent += (1.0 - abs(bent) ** 1.5 * along) * STIFFNESS_1_RAD * turn
        found[index] = bent
    return FORCE_N_M * found


def asymmetry(x) -> np.ndarray:
    return 0.012 * np.abs(x.v)


@cache
def fit_of(extra: Law | None) -> Fit:
    return fit_model(make_dataset(recordings(Joint(extra=extra), seed=5), FACTS, Processing()), DEFAULT)


@pytest.fixture(scope="module")
def bent() -> Fit:
    return fit_of(hose)


@pytest.fixture(scope="module")
def found(bent: Fit) -> Diagnosis:
    return diagnose(bent)


def test_it_is_none_of_the_catalogue_and_a_curve_is_offered(bent, found):
    assert (found.verdict, found.driver) == ("unknown-effect", "since_reversal"), found.sentence
    assert found.remains
    assert "hoses" in found.sentence
    offered = provisional(bent, found)
    assert offered.effect.name == "curve_of_since_reversal_against_motion"
    assert offered.gain.low > 0.0


def bends(fit: Fit) -> bool:
    """Whether steady sliding says so."""
    return judged(fit).steady.driver == "since_reversal"


@pytest.mark.parametrize("extra", [None, asymmetry])
def test_nothing_bends_where_nothing_does(extra):
    assert not bends(fit_of(extra))


@pytest.mark.parametrize(("extra", "there"), [(lambda x: hose(x) + asymmetry(x), True), (asymmetry, False)])
def test_what_bends_beside_a_name_is_told_once_the_name_is_in_the_model(extra, there):
    fit = fit_of(extra)
    assert bends(fit_effects(fit, [*fit.names, "viscous_asymmetry"])) == there


def test_what_is_small_bends_where_no_luck_brings_it_and_it_helps_for_sure(monkeypatch):
    fit = fit_of(lambda x: WEAK * hose(x))
    assert bends(fit)
    monkeypatch.setattr(confirmation, "SIGNIFICANT", 1e-4)
    assert not bends(fit)


def test_a_formula_that_is_confirmed_is_its_name_unless_the_curve_helps_beside_it(bent, monkeypatch):
    monkeypatch.setattr(unfollowed, "is_confirmed", lambda _: True)
    assert bends(bent)
    monkeypatch.setattr(unfollowed, "is_helpful", lambda *_: False)
    assert not bends(bent)


def test_nothing_bends_to_and_fro_along_with_a_shaft_that_turns_on():
    """It is not even asked: what is left where a motor speeds up would look like it."""
    assert "since_reversal" in free_curves(fit_of(None).dataset)
    assert "since_reversal" not in free_curves(turns_one_way(2, lead=0.06).dataset)
