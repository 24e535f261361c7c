"""What the model's own offset may be is told, though no residual shows it."""

import numpy as np
import pytest

from compensator.lab.diagnosis.absorbed import LEAST_SHARE, absorbed
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, recordings

COULOMB_N_M = 0.08


def diagnosed(share):
    """A joint whose dry friction differs by direction, by a share of it to either side."""
    joint = Joint(offset=0.0, extra=lambda x: share * COULOMB_N_M * np.abs(np.sign(x.v)))
    dataset = make_dataset(recordings(joint, seed=3), FACTS, Processing(cutoff_hz=8.0))
    return diagnose(fit_model(dataset, default_effects(FACTS)))


@pytest.mark.parametrize(("share", "told"), [(0.14, True), (-0.14, True), (0.4 * LEAST_SHARE, False), (0.0, False)])
def test_an_offset_that_may_be_friction_by_direction_is_told(share, told):
    found = diagnosed(share)
    assert found.verdict == "nothing"
    assert ("of dry friction: it may as well be direction-asymmetric Coulomb friction" in found.sentence) == told
    assert ("would." in found.sentence) == told


def test_beside_a_name_it_is_a_note_with_its_numbers():
    joint = Joint(offset=0.0, extra=lambda x: 0.14 * COULOMB_N_M * np.abs(np.sign(x.v)) + 0.15 * (x.q - 0.8))
    dataset = make_dataset(recordings(joint, seed=3), FACTS, Processing(cutoff_hz=8.0))
    found = diagnose(fit_model(dataset, default_effects(FACTS)))
    assert found.verdict == "missing"
    (note,) = (one for one in found.notes if one.code == "absorbed")
    assert (note.values["effect"], note.values["unit"]) == ("coulomb_asymmetry", "N m")
    assert note.values["share"] > LEAST_SHARE
    assert note.text not in found.sentence


@pytest.mark.parametrize("spring", ["spring", "hardening_spring"])
def test_a_spring_of_the_model_may_have_its_constant_part_in_the_offset(spring):
    """It pulls towards a rest position that is not zero."""
    joint = Joint(offset=0.0, extra=lambda x: 0.15 * (x.q - 0.2))
    dataset = make_dataset(recordings(joint, seed=3), FACTS, Processing(cutoff_hz=8.0))
    fit = fit_model(dataset, [*default_effects(FACTS), spring])
    (note,) = absorbed(fit, ["coulomb_asymmetry"])
    assert "may as well be the constant part of the model's" in note.text
    assert "or direction-asymmetric Coulomb friction" in note.text
    assert note.values["constant_part_of"] == spring
    (without,) = absorbed(fit_model(dataset, default_effects(FACTS)), ["coulomb_asymmetry"])
    assert "constant_part_of" not in without.values


def test_an_offset_that_the_effect_named_has_made_is_no_friction_by_direction():
    """Damping by direction, as long as it is missing, leaves its mean in the offset."""
    joint = Joint(offset=0.0, extra=lambda x: 0.02 * np.abs(x.v))
    dataset = make_dataset(recordings(joint, seed=3), FACTS, Processing(cutoff_hz=8.0))
    base = fit_model(dataset, default_effects(FACTS))
    assert absorbed(base, ["coulomb_asymmetry"])
    found = diagnose(base)
    assert found.named == ("viscous_asymmetry",)
    assert not [one for one in found.notes if one.code == "absorbed"]


def test_without_coulomb_friction_there_is_nothing_that_the_offset_is_a_share_of():
    dataset = make_dataset(recordings(Joint(offset=0.1), seed=3), FACTS, Processing(cutoff_hz=8.0))
    fit = fit_model(dataset, [name for name in default_effects(FACTS) if name != "coulomb"])
    assert absorbed(fit, ["coulomb_asymmetry"]) == []
