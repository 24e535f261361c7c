"""Effects that build on the load are held against each other, each on the load of the model with it."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening import own_load
from compensator.lab.screening.evidence import score_of
from compensator.lab.screening.gathering import gather
from compensator.lab.screening.own_load import on_own_load
from tests.lab.diagnosis.test_diagnose import SHAKEN
from tests.lab.far_side import ARM_KG_M2, missing_torque, twisting
from tests.lab.synthetic import FACTS, Joint, plans, recordings


def wide_teeth(x):
    """Teeth that hardly bounce, with so much free play that a model without it weighs the arm wrongly."""
    return missing_torque(x, 400.0, 2.0, 0.2)


@pytest.fixture(scope="module")
def gathered():
    drawn = replace(FACTS, arm_inertia_kg_m2=1.1 * ARM_KG_M2)
    made = recordings(Joint(extra=wide_teeth), trials=[*plans(), *SHAKEN], seed=4)
    fit = fit_model(make_dataset(made, drawn, Processing()), default_effects(drawn))
    return gather(widened(fit, "moving"), "moving")


def best_score(found, name):
    return max(score_of(found.bases, block) for block in found.named if block.name == name)


def test_the_cause_gains_by_the_load_that_it_leaves(gathered):
    own = on_own_load(gathered)
    gained = {name: best_score(own, name) - best_score(gathered, name) for name in ("backlash", "elasticity")}
    assert gained["backlash"] > max(5.0, gained["elasticity"])
    scanned = own.named[: len(gathered.named)]
    assert [(block.name, block.key) for block in scanned] == [(block.name, block.key) for block in gathered.named]
    for block, before in zip(scanned, gathered.named, strict=True):
        assert (block is before) == (block.name not in gained)
    assert [block.name for block in own.named[len(scanned) :]] == ["backlash", "elasticity"]


def test_an_effect_without_a_rival_stays_on_the_load_of_the_model(gathered, monkeypatch):
    alone = replace(gathered, named=[block for block in gathered.named if block.name != "elasticity"])
    monkeypatch.setattr(own_load, "fit_model", lambda *_: pytest.fail("nothing is to be fitted"))
    own = on_own_load(alone)
    assert all(one is before for one, before in zip(own.named, alone.named, strict=False))
    assert [block.name for block in own.named[len(alone.named) :]] == ["backlash"]


def test_a_shape_is_found_between_those_scanned_and_pays_for_having_been_looked_for():
    drawn = replace(FACTS, arm_inertia_kg_m2=ARM_KG_M2)
    made = recordings(Joint(extra=twisting), trials=[*plans((0.0, 0.25))[::2], *SHAKEN[::2]], seed=4)
    fit = fit_model(make_dataset(made, drawn, Processing()), default_effects(drawn))
    scanned = gather(widened(fit, "moving"), "moving")
    found = on_own_load(scanned).named[-1]
    assert found.name == "elasticity"
    assert found.key[0] == pytest.approx(50.0 / (2.0 * np.pi), rel=0.05)
    assert score_of(scanned.bases, found) > best_score(scanned, "elasticity") + 10.0
    assert found.scanned > next(block.scanned for block in scanned.named if block.name == "elasticity")
