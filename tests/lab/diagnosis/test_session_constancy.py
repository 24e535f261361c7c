"""An effect that is named, and that is another one in each part of the session, only imitates what is there."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from compensator.lab.diagnosis import session_constancy
from compensator.lab.diagnosis.session_constancy import InSession, change_in_session
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.effects.effect import SESSION_START
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.clearing import with_noise
from compensator.lab.screening.evidence import VERY_STRONG
from tests.lab.synthetic import FACTS, Bench, Joint, Truth, plans, record

DEFAULT = default_effects(FACTS)
NAME = "centre_of_mass_angle"


def turned(x: Truth, angle_rad: float) -> np.ndarray:
    """What an arm weighs more that is turned against its encoder."""
    return angle_rad * (Joint().arm_moment + x.weight_n_m) * np.cos(x.q)


TRIALS = plans(repeats=2)


def change(angle_rad: Callable[[int], float], kept: Sequence[int] = range(len(TRIALS))) -> InSession | None:
    """In the session, when trial by trial the arm is turned by so much, the trials kept in another order."""
    random = np.random.default_rng(7)
    made = [
        record(
            replace(plan, conditions={**plan.conditions, SESSION_START: 60.0 * index}),
            Joint(extra=partial(turned, angle_rad=angle_rad(index))),
            Bench(),
            random,
        )
        for index, plan in enumerate(TRIALS)
    ]
    fit = fit_model(make_dataset([made[index] for index in kept], FACTS, Processing()), DEFAULT)
    gathered = with_noise(gather(fit))
    named = next(block for block in gathered.named if block.name == NAME)
    return change_in_session(fit_effects(fit.dataset, [*fit.names, NAME], fit.training), gathered, named)


def slipped(trial: int) -> float:
    return 0.04 if trial >= 11 else 0.0


def test_what_slips_in_the_middle_is_another_one_since():
    found = change(slipped)
    assert found is not None
    assert found.trial == TRIALS[11].name
    assert found.before == pytest.approx(0.0, abs=0.1)
    assert found.since > 1.0


def test_what_was_always_there_is_the_same():
    assert change(lambda trial: 0.04) is None


def test_what_changes_by_a_little_may_be_what_the_formula_leaves_open(monkeypatch):
    def a_little(trial: int) -> float:
        return 0.4 if trial >= 11 else 0.38

    assert change(a_little) is None
    monkeypatch.setattr(session_constancy, "LEAST_CHANGE", 0.01)
    found = change(a_little)
    assert found is not None
    assert found.since - found.before == pytest.approx(0.05, rel=0.3)


def test_trials_are_put_in_the_order_in_which_they_were_recorded():
    shuffled = np.random.default_rng(3).permutation(len(TRIALS))
    found = change(slipped, [int(one) for one in shuffled])
    assert found is not None
    assert found.trial == TRIALS[11].name


def test_before_a_change_a_tenth_of_what_tells_of_the_effect_has_to_lie():
    """One trial alone may be unlike the others for many reasons."""
    assert change(lambda trial: 0.04 if trial >= 1 else 0.0) is None


@pytest.mark.parametrize(("over_all", "beside_the_formula", "told"), [(2, 2, True), (0.5, 2, False), (2, 0.5, False)])
def test_the_likeliest_change_has_to_stand_beside_what_the_formula_leaves_open(
    over_all, beside_the_formula, told, monkeypatch
):
    def score_of(bases, block, _):
        """The likeliest of the changes that are tried, and then that one alone."""
        return VERY_STRONG * (over_all if block.scanned > 1 else beside_the_formula)

    monkeypatch.setattr(session_constancy, "score_of", score_of)
    assert (change(slipped) is not None) == told


def test_a_change_has_to_lower_the_held_out_error(monkeypatch):
    monkeypatch.setattr(session_constancy, "score_of", lambda *_: 2.0 * VERY_STRONG)
    found = change(lambda trial: 0.04)
    assert found is None
