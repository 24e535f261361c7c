"""An effect that a Stribeck curve has been drawn to imitate: named by the shapes that the model has beside it."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis import drawn_shape, four_families
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.drawn_shape import answer_beside
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.gain import Gain
from compensator.lab.next_trial.suggest import d_prime_of
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.clearing import with_noise
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, recordings

BENCH = Bench(duration_s=6.0, noise=0.001)
SLOW = [Plan("slow", [(1.0, 0.1, 0.3)]), Plan("slow-loaded", [(1.0, 0.11, 0.9)], load_kg=0.1)]
FAST = [Plan("fast", [(1.2, 0.7, 0.2)]), Plan("fast-loaded", [(1.2, 0.8, 0.2)], load_kg=0.1)]
TRUE = (0.2, 2.0)  # speed [rad/s] and exponent of the Stribeck curve
DRAG = 0.004  # N m s2/rad2


def fitted(drag=DRAG):
    joint = Joint(stribeck_speed=TRUE[0], stribeck_exponent=TRUE[1], extra=lambda x: drag * x.v * np.abs(x.v))
    made = recordings(joint, BENCH, [*SLOW, *FAST], 0)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


@pytest.fixture(scope="module")
def fit():
    return fitted()


@pytest.fixture(scope="module")
def diagnosis(fit):
    return diagnose(fit)


def test_a_drag_that_the_stribeck_curve_imitates_is_named(fit, diagnosis, monkeypatch):
    assert fit.shapes["stribeck"][0] > 5.0 * TRUE[0]
    assert (diagnosis.verdict, diagnosis.classes[0]) == ("missing", ("viscous_quadratic",))
    monkeypatch.setattr(four_families, "answer_beside", lambda *_: None)
    assert diagnose(fit).verdict != "missing"


def test_the_shapes_that_it_is_judged_at_are_near_the_truth_and_suggestions_go_on_from_them(fit, diagnosis):
    assert diagnosis.shapes is not None
    np.testing.assert_allclose(diagnosis.shapes["stribeck"], TRUE, rtol=0.25)
    beside, drawn = (d_prime_of(fit, one, "viscous_quadratic") for one in (diagnosis, replace(diagnosis, shapes=None)))
    assert beside > 2.0 * drawn


def test_a_complete_joint_has_no_shape_that_imitates_anything():
    complete = fitted(drag=0.0)
    found = diagnose(complete)
    assert (found.verdict, found.shapes) == ("nothing", None)
    assert drawn_shape._beside_drawn_shapes(complete, with_noise(gather(complete))) is None


@pytest.mark.parametrize(("score", "is_looked_at"), [(9.0, False), (11.0, True)])
def test_shapes_are_those_found_unless_the_likelihood_speaks_very_strongly_against_them(
    fit, monkeypatch, score, is_looked_at
):
    monkeypatch.setattr(drawn_shape, "_score", lambda *_: score)
    assert (drawn_shape._beside_drawn_shapes(fit, with_noise(gather(fit))) is not None) is is_looked_at


def test_the_error_must_fall_from_that_of_the_model_as_it_is(fit, monkeypatch):
    judged = []

    def no_gain(candidate, before, *_):
        judged.append(before)
        return replace(candidate, gain=Gain(-0.01, -0.02, 0.0))

    monkeypatch.setattr(drawn_shape, "as_in_the_ladder", no_gain)
    assert answer_beside(fit, with_noise(gather(fit))) is None
    assert judged == [fit]


def test_a_second_look_counts_twice(fit, monkeypatch):
    once = []

    def kept(*args):
        once.append(real(*args))
        return once[-1]

    real = drawn_shape.answer_of
    monkeypatch.setattr(drawn_shape, "answer_of", kept)
    answer, _ = answer_beside(fit, with_noise(gather(fit)))
    assert answer.p_value == pytest.approx(2.0 * once[0].p_value)
    unsure = replace(once[0], p_value=0.006)
    monkeypatch.setattr(drawn_shape, "answer_of", lambda *_: unsure)
    assert answer_beside(fit, with_noise(gather(fit))) is None
