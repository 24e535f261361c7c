"""An effect that is named, and that is another one in each part of the session, only imitates what is there."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from compensator.lab.diagnosis.session_constancy import InSession, change_in_session
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.clearing import with_noise
from tests.lab.synthetic import FACTS, Bench, Joint, Truth, plans, record

DEFAULT = default_effects(FACTS)
NAME = "centre_of_mass_angle"


def turned(x: Truth, angle_rad: float) -> np.ndarray:
    """What an arm weighs more that is turned against its encoder."""
    return angle_rad * (Joint().arm_moment + x.weight_n_m) * np.cos(x.q)


def change(angle_rad: Callable[[int], float]) -> InSession | None:
    """In the session, when trial by trial the arm is turned by so much."""
    random = np.random.default_rng(7)
    made = [
        record(plan, Joint(extra=partial(turned, angle_rad=angle_rad(index))), Bench(), random)
        for index, plan in enumerate(plans(repeats=2))
    ]
    fit = fit_model(make_dataset(made, FACTS, Processing()), DEFAULT)
    gathered = with_noise(gather(fit))
    named = next(block for block in gathered.named if block.name == NAME)
    return change_in_session(fit_effects(fit.dataset, [*fit.names, NAME], fit.training), gathered, named)


def test_what_slips_in_the_middle_is_another_one_since():
    trials = plans(repeats=2)
    found = change(lambda trial: 0.04 if trial >= 11 else 0.0)
    assert found is not None
    assert found.trial == trials[11].name
    assert found.before == pytest.approx(0.0, abs=0.1)
    assert found.since > 1.0


def test_what_was_always_there_is_the_same():
    assert change(lambda trial: 0.04) is None
