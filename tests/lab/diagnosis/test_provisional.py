"""A curve that stands in the model for what has no formula yet."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.unfollowed import provisional
from compensator.lab.effects.catalogue import catalogue, default_effects, effect_named
from compensator.lab.effects.free_curve import known, name_of
from compensator.lab.errors import UnknownEffectError
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, recordings

DEFAULT = default_effects(FACTS)


def bump(q):
    """Friction where a cable catches [N m]: no formula of the catalogue."""
    return 0.12 * np.exp(-(((q - 0.2) / 0.25) ** 2))


@pytest.fixture(scope="module")
def fit():
    made = recordings(Joint(extra=lambda x: bump(x.q) * np.sign(x.v)), seed=3)
    return fit_model(make_dataset(made, FACTS, Processing()), DEFAULT)


@pytest.fixture(scope="module")
def found(fit):
    return diagnose(fit)


def test_what_varies_with_position_against_motion_is_offered_as_such_a_curve(fit, found):
    assert found.verdict == "unknown-effect", found.sentence
    offered = provisional(fit, found)
    assert offered.effect.name == "curve_of_position_against_motion"
    assert offered.after < 0.5 * offered.before
    assert offered.gain.low > 0.0


def test_the_picture_is_the_curve_that_was_hidden(fit, found):
    drawn = provisional(fit, found).picture
    assert drawn.against_motion
    assert drawn.driver == "position"
    inside = np.abs(drawn.curve.x - 0.2) < 0.8
    hidden, curve = bump(drawn.curve.x[inside]), drawn.curve.mean[inside]
    assert np.corrcoef(curve, hidden)[0, 1] > 0.9
    assert np.ptp(curve) == pytest.approx(np.ptp(hidden), rel=0.3)


def test_once_it_is_in_the_model_nothing_of_it_is_left(fit, found):
    name = provisional(fit, found).effect.name
    filled = fit_effects(fit, [*fit.names, name])
    again = diagnose(filled)
    assert provisional(filled, again) is None or provisional(filled, again).effect.name != name
    assert len(filled.shapes[name]) == 7
    assert list(filled.shapes[name]) == sorted(filled.shapes[name])


def test_damping_that_differs_along_the_path_is_offered_as_a_curve_times_the_speed():
    made = recordings(Joint(extra=lambda x: bump(x.q) * x.v), seed=3)
    fit = fit_model(make_dataset(made, FACTS, Processing()), DEFAULT)
    found = diagnose(fit)
    assert (found.verdict, found.driver) == ("unknown-effect", "position times speed"), found.sentence
    offered = provisional(fit, found)
    assert offered.effect.name == "curve_of_position_times_speed"
    assert offered.after < 0.6 * offered.before
    assert offered.effect.parameters[0].unit == "{effort} s/{position}"


def test_its_knots_are_of_all_trials():
    """Not of the first one, which may be cold."""
    cold, warm = (np.full(41, temperature) for temperature in (20.0, 40.0))
    effect = effect_named("curve_of_temperature")
    motions = [replace(_motion(), temperature_c=values) for values in (cold, warm)]
    (knots,) = effect.grid(motions)
    assert (knots[0], knots[-1]) == (20.0, 40.0)
    assert np.diff(knots) == pytest.approx(20.0 / 6.0)


def _motion():
    from tests.lab.effects.test_effects import motion

    return motion()


def test_names_of_curves():
    assert name_of("temperature against motion") == "curve_of_temperature_against_motion"
    assert name_of("load_kg") == "curve_of_load_kg"
    assert name_of("since_reversal") == "curve_of_since_reversal_against_motion"
    assert name_of("moon") is None
    assert not set(known()) & set(catalogue())
    for name in known():
        effect = effect_named(name)
        assert effect.provisional
        (knots,) = effect.grid([_motion()])
        assert len(knots) == len(effect.shape_names) == 7
        assert effect.columns(_motion(), knots).shape == (6, 41) == (len(effect.parameters), 41)
    with pytest.raises(UnknownEffectError, match="curve_of_position"):
        effect_named("curve_of_positon")


def test_a_curve_is_nothing_at_its_first_knot_and_linear_between():
    effect, moment = effect_named("curve_of_position"), _motion()
    knots = (-1.0, -0.5, 0.0, 0.2, 0.4, 0.6, 1.0)
    heights = np.array([1.0, 0.0, 2.0, 2.0, 2.0, 2.0])
    wanted = np.interp(moment.position, knots, [0.0, *heights])
    assert heights @ effect.columns(moment, knots) == pytest.approx(wanted)
    friction = effect_named("curve_of_position_against_motion")
    assert heights @ friction.columns(moment, knots) == pytest.approx(wanted * moment.direction)


def test_a_name_needs_no_curve():
    made = recordings(Joint(extra=lambda x: 0.02 * np.abs(x.v)), seed=3)
    fit = fit_model(make_dataset(made, FACTS, Processing()), DEFAULT)
    assert provisional(fit, diagnose(fit)) is None


def test_a_curve_after_reversals_leaves_coulomb_friction_to_the_motion_far_from_them():
    """Most of the time the joint stands: knots there, and no row, would make the curve all of the dry friction."""
    effect, moment = effect_named("curve_of_since_reversal_against_motion"), _motion()
    travel = moment.strokes.travel
    knots = tuple(np.linspace(0.0, 0.7 * travel.max(), 7))
    assert effect.columns(moment, knots)[:, travel > knots[-1]] == pytest.approx(0.0)
    assert effect.columns(moment, knots)[0] == pytest.approx(
        np.clip(1.0 - travel / knots[1], 0.0, 1.0) * moment.direction
    )
    assert effect.parameters[0].name == "at the first knot"
    stands = replace(moment, velocity=np.where(np.arange(41) < 30, 0.0, moment.velocity))
    (places,) = effect.grid([stands])
    assert places[0] == travel[30:][np.abs(moment.velocity[30:]) > moment.slow].min()
