"""What bends along with the joint and slides is none of the catalogue, whatever formula imitates a part of it."""

import numpy as np
import pytest

from compensator.lab.diagnosis.bending import bending, still_bending
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.provisional import provisional
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import Fit, fit_effects, fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.clearing import with_noise
from tests.lab.synthetic import FACTS, Joint, Law, recordings

DEFAULT = default_effects(FACTS)
FORCE_N_M, STIFFNESS_1_RAD = 0.012, 6.0


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


def fit_of(extra: Law | None) -> Fit:
    return fit_model(make_dataset(recordings(Joint(extra=extra), seed=5), FACTS, Processing()), DEFAULT)


@pytest.fixture(scope="module")
def bent() -> Fit:
    return fit_of(hose)


def test_it_is_none_of_the_catalogue_and_a_curve_is_offered(bent):
    found = diagnose(bent)
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


def test_a_name_that_imitates_a_part_does_not_hide_the_rest():
    fit = fit_of(lambda x: hose(x) + asymmetry(x))
    gathered = with_noise(gather(fit))
    named = next(block for block in gathered.named if block.name == "viscous_asymmetry")
    explained = fit_effects(fit.dataset, [*fit.names, named.name], fit.training)
    assert still_bending(explained, gathered, named)


def test_a_name_that_is_right_leaves_nothing_that_bends():
    fit = fit_of(asymmetry)
    gathered = with_noise(gather(fit))
    named = next(block for block in gathered.named if block.name == "viscous_asymmetry")
    explained = fit_effects(fit.dataset, [*fit.names, named.name], fit.training)
    assert not still_bending(explained, gathered, named)
