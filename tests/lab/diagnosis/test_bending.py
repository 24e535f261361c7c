"""What bends along with the joint and slides is none of the catalogue, whatever formula imitates a part of it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from compensator.lab.diagnosis import bending as own
from compensator.lab.diagnosis.bending import Bending, bending
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.diagnosis.unfollowed import provisional
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model, with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain
from compensator.lab.model.validation import held_out
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.evidence import screen_against_noise
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.diagnosis.test_slow_turns import fitted as turns_one_way
from tests.lab.synthetic import FACTS, Joint, Law, recordings

DEFAULT = default_effects(FACTS)
FORCE_N_M, STIFFNESS_1_RAD = 0.012, 6.0
WEAK = 0.07  # of it: there, and not beyond doubt, though no luck


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


@pytest.mark.parametrize("extra", [None, asymmetry])
def test_nothing_bends_where_nothing_does(extra):
    fit = fit_of(extra)
    assert bending(fit, with_noise(gather(fit))) is None


@pytest.mark.parametrize(("extra", "bends"), [(lambda x: hose(x) + asymmetry(x), True), (asymmetry, False)])
def test_what_bends_beside_a_name_is_told_once_the_name_is_in_the_model(extra, bends):
    fit = fit_of(extra)
    explained = fit_effects(fit.dataset, [*fit.names, "viscous_asymmetry"], fit.training)
    assert (bending(explained, with_noise(gather(explained))) is not None) == bends


@pytest.fixture(scope="module")
def weakly_bent() -> Fit:
    return fit_of(lambda x: WEAK * hose(x))


def test_what_is_small_bends_where_no_luck_brings_it(weakly_bent, monkeypatch):
    gathered = with_noise(gather(weakly_bent))
    assert bending(weakly_bent, gathered) is not None
    monkeypatch.setattr(own, "SIGNIFICANT", 1e-4)
    assert bending(weakly_bent, gathered) is None


def test_the_error_need_only_fall_where_the_evidence_is_very_strong(bent, weakly_bent, monkeypatch):
    """Few trials may turn back where it shows, so that no interval over trials is above zero."""
    monkeypatch.setattr(own, "held_out_gain", lambda *_: Gain(0.05, low=-0.01, high=0.1))
    assert bending(bent, with_noise(gather(bent))) is not None
    assert bending(weakly_bent, with_noise(gather(weakly_bent))) is None


def test_it_has_to_lower_the_held_out_error(bent, monkeypatch):
    gathered = with_noise(gather(bent))
    found = bending(bent, gathered)
    assert found is not None
    before = held_out(bent, None, bent.dataset.steadiness)
    monkeypatch.setattr(own, "LEAST_GAIN", 1.05 * (1.0 - found.after.rms / before.rms))
    assert bending(bent, gathered) is None


def free_hysteresis(fit: Fit) -> Bending:
    """Whatever its evidence."""
    gathered = with_noise(gather(fit))
    assert gathered.noise is not None
    evidence = screen_against_noise(gathered.bases, [gathered.curves.hysteresis], gathered.noise).evidence[0]
    model = with_columns(fit, evidence.block.name, gathered.curves.hysteresis_columns)
    return Bending(evidence, held_out(model, None, fit.dataset.steadiness), 0.0)


def test_it_predicts_best_where_no_formula_does_as_well(bent, found):
    assert free_hysteresis(bent).predicts_best(bent, found.candidates)


def test_what_cannot_be_it_is_no_better_prediction():
    fit = fit_of(asymmetry)
    candidates = diagnose(fit).candidates
    free = free_hysteresis(fit)
    assert not free.predicts_best(fit, candidates)
    assert free.predicts_best(fit, [replace(one, physical=False) for one in candidates])


def test_nothing_bends_to_and_fro_along_with_a_shaft_that_turns_on(monkeypatch):
    """It is not even asked: what is left where a motor speeds up would look like it."""
    fit = turns_one_way(2, lead=0.06)
    gathered = with_noise(gather(fit))

    def never(*_arguments):
        raise AssertionError("a hysteresis was looked for")

    monkeypatch.setattr(own, "screen_against_noise", never)
    assert bending(fit, gathered) is None
