"""The best shape of an effect of the load lies between those scanned."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening import between_scanned
from compensator.lab.screening.between_scanned import with_shapes_between
from compensator.lab.screening.evidence import score_of
from compensator.lab.screening.gathering import gather
from tests.lab.diagnosis.test_diagnose import SHAKEN
from tests.lab.far_side import ARM_KG_M2, twisting
from tests.lab.synthetic import FACTS, Joint, plans, recordings


def best_score(found, name):
    return max(score_of(found.bases, block) for block in found.named if block.name == name)


@pytest.fixture(scope="module")
def scanned():
    drawn = replace(FACTS, arm_inertia_kg_m2=ARM_KG_M2)
    made = recordings(Joint(extra=twisting), trials=[*plans((0.0, 0.25))[::2], *SHAKEN[::2]], seed=4)
    fit = fit_model(make_dataset(made, drawn, Processing()), default_effects(drawn))
    return gather(widened(fit, "moving"), "moving")


def test_a_shape_is_found_between_those_scanned_and_pays_for_having_been_looked_for(scanned):
    found = with_shapes_between(scanned).named[-1]
    assert found.name == "elasticity"
    assert found.shape[0] == pytest.approx(50.0 / (2.0 * np.pi), rel=0.05)
    assert score_of(scanned.bases, found) > best_score(scanned, "elasticity") + 10.0
    assert found.scanned > next(block.scanned for block in scanned.named if block.name == "elasticity")


def test_it_is_looked_for_where_a_shape_is_its_effect(scanned, monkeypatch):
    kept = replace(effect_named("elasticity"), searched=lambda shape: shape[0] < 7.0)
    monkeypatch.setattr(between_scanned, "effect_named", lambda name: kept if name == kept.name else effect_named(name))
    assert with_shapes_between(scanned).named[-1].shape[0] < 7.0


def test_nothing_is_looked_for_of_an_effect_whose_evidence_does_not_pay(scanned):
    silent = [replace(block, columns=np.zeros_like(block.columns)) for block in scanned.named]
    assert with_shapes_between(replace(scanned, named=silent)).named == silent
