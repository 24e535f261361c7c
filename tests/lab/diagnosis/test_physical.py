"""Which sizes, signs and shapes of a fitted model cannot be those of an effect, whatever they explain."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from compensator.lab.diagnosis.physical import POSSIBLE, why_impossible
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.recordings.facts import Facts

TOLD = Facts(backlash_rad=0.005, stiffness_n_m_rad=0.02 * (20.0 * np.pi) ** 2, arm_inertia_kg_m2=0.02)
PLAY, BEYOND = (0.011, 0.25), "load beyond the gap over the load that is known"


def fitted(name: str, shape: tuple[float, ...], value: float = 1.0, held: bool = False, facts: Facts = TOLD) -> Any:
    """A model whose only term is an effect, of dry friction of 0.1 N m."""
    motion = SimpleNamespace(step_s=0.01, facts=facts, position_span=2.0, slow=0.05, fast=2.0)
    dataset = SimpleNamespace(
        effort_definition=SimpleNamespace(unit="N m", quantity="torque"),
        facts=facts,
        trials=[SimpleNamespace(motion=motion)],
    )
    effect = effect_named(name)
    count = len(effect.parameters)
    term = SimpleNamespace(
        effect=effect, shape=shape, at_bound=np.full(count, held), coefficients=np.full(count, value)
    )
    return SimpleNamespace(terms=(term,), dataset=dataset, dry_friction=0.1)


@pytest.mark.parametrize(
    ("name", "shape", "end"),
    [
        ("elasticity", (38.0, 0.3, 0.4), False),
        ("elasticity", (38.0, 0.3, 1.0), False),  # the arm may be all that turns
        ("elasticity", (60.0, 0.3, 0.4), False),  # beyond half the sample rate its compliance is seen
        ("elasticity", (3.0, 0.3, 0.4), True),
        ("elasticity", (8.0, 0.06, 0.4), False),  # it is hardly damped
        ("elasticity", (100.0, 0.3, 0.4), True),
        ("elasticity", (100.0 * (1.0 - 1e-15), 0.3, 0.4), True),  # a logarithm and back may make that of 100
        ("elasticity", (8.0, 0.7, 0.4), True),  # nothing swings
        ("effort_filter", (0.008,), True),  # a delay to second order
        ("effort_filter", (0.02,), False),
        ("effort_filter", (0.5,), True),
        ("pre_sliding", (2e-4,), True),
        ("pre_sliding", (5e-4,), False),
        ("pre_sliding", (0.2,), True),
        ("frictional_lag", (0.1, 0.02), True),  # as the measuring chain makes a sign late
        ("frictional_lag", (0.3, 0.02), False),
    ],
)
def test_a_shape_at_an_end_of_its_scan_goes_on_beyond_it(name, shape, end):
    found = why_impossible(fitted(name, shape, 0.06, facts=Facts()), name)
    assert found.words.endswith("that it can be") == end
    assert (found == POSSIBLE) != end


@pytest.mark.parametrize(
    ("name", "shape", "possible"),
    [
        ("backlash", (0.009, 0.25), False),  # the data sheet says 5 mrad
        ("backlash", PLAY, True),
        ("elasticity", (8.0, 0.06, 0.5), False),  # and 10 Hz
        ("elasticity", (6.0, 0.06, 0.5), True),
    ],
)
def test_hardly_more_than_the_owner_tells_of_is_not_missing(name, shape, possible):
    assert (why_impossible(fitted(name, shape), name) == POSSIBLE) == possible
    assert why_impossible(fitted(name, shape, facts=Facts()), name) == POSSIBLE


@pytest.mark.parametrize(
    ("name", "shape", "value", "held", "why", "badge"),
    [
        ("backlash", (0.009, 0.25), 1.0, False, "known from the rig (free play 0.009 rad)", "known from the rig"),
        ("backlash", PLAY, 1.0, False, "", ""),
        ("backlash", PLAY, 3.0, True, "", ""),  # an upper bound may hold it: it is there
        ("backlash", PLAY, 0.3, True, f"its {BEYOND} would have to be less than 0.3", "unphysical size"),
        (
            "pre_sliding",
            (2e-3,),
            0.0,
            True,
            "its friction that comes up over a distance would have to be less than 0 N m",
            "unphysical sign",
        ),
        (
            "viscous_temperature",
            (),
            0.0,
            True,
            "its viscous friction per kelvin would have to be more than 0 N m s/(rad K)",
            "unphysical sign",
        ),
        ("warm_up", (50.0,), 0.0, True, "its cold excess would have to be less than 0 N m", "unphysical sign"),
        ("pre_sliding", (2e-3,), 0.01, False, "it would be under 50% of dry friction", "too small"),
        ("frictional_lag", (0.3, 0.011), 0.01, False, "of this shape it is something else", "limit of the scan"),
        ("frictional_lag", (0.3, 0.011), 0.1, False, "", ""),  # three times the friction for so long is it for 33 ms
        ("frictional_lag", (0.3, 0.02), 1.0, False, "of this shape it is something else", "limit of the scan"),
    ],
)  # fmt: skip
def test_what_is_impossible_about_it_is_told_with_its_number(name, shape, value, held, why, badge):
    assert why_impossible(fitted(name, shape, value, held), name) == (why, badge)


@pytest.mark.parametrize(("held", "possible"), [((True, True), False), ((True, False), True), ((False, True), True)])
def test_a_bound_refuses_an_effect_where_it_holds_all_of_its_coefficients(held, possible):
    """Dry friction may lag and viscous friction not, or the other way round."""
    fit = fitted("frictional_lag", (0.3, 0.02))
    (term,) = fit.terms
    term.at_bound, term.coefficients = np.array(held), np.where(held, 0.0, 0.05)
    found = why_impossible(fit, "frictional_lag")
    assert (found == POSSIBLE) == possible
    assert possible or found.words == "its dry friction that lags would have to be less than 0 N m"
