"""Effects that build on the load are held against each other, each on the load of the model with it."""

from dataclasses import replace

import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening import own_load
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.evidence import score_of
from compensator.lab.screening.own_load import on_own_load
from tests.lab.diagnosis.test_diagnose import SHAKEN
from tests.lab.far_side import ARM_KG_M2, missing_torque
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
    others = [block for block in gathered.named if block.name not in gained]
    assert [block for block in own.named if block.name not in gained] == others
    assert [(block.name, block.key) for block in own.named] == [(block.name, block.key) for block in gathered.named]


def test_an_effect_without_a_rival_stays_as_it_is(gathered, monkeypatch):
    alone = replace(gathered, named=[block for block in gathered.named if block.name != "elasticity"])
    monkeypatch.setattr(own_load, "fit_model", lambda *_: pytest.fail("nothing is to be fitted"))
    assert on_own_load(alone) is alone
