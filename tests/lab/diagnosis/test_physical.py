"""Which sizes, signs and shapes cannot be those of an effect, whatever they explain."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from compensator.lab.diagnosis import physical
from compensator.lab.diagnosis.physical import (
    badge_of,
    is_before_scan,
    is_past_scan,
    is_within_bounds,
    why_at_end,
    why_not_physical,
    why_not_possible,
)
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.recordings.facts import Facts
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import Evidence


@pytest.mark.parametrize(
    ("share", "noncentrality", "possible"),
    [
        (0.5, 400.0, True),
        (0.29, 400.0, True),  # 0.3 is the least, and lies within two standard errors
        (0.29, 40000.0, False),  # it does not: they are a tenth as large
        (0.2, 400.0, False),
        (-0.5, 400.0, False),
    ],
)
def test_a_size_beyond_its_bounds_for_sure_cannot_be(share, noncentrality, possible):
    column = np.sin(np.arange(200.0))
    item = Evidence(Block("backlash", column[:, None], 0, 15, (0.02,)), 50.0, noncentrality, 0.001, column)
    dataset = SimpleNamespace(effort_definition=SimpleNamespace(quantity="torque"))
    gathered: Any = SimpleNamespace(
        bases=[Base(np.zeros((200, 1)), share * column)], fit=SimpleNamespace(dataset=dataset)
    )
    assert is_within_bounds(gathered, item) == possible


@pytest.mark.parametrize(
    ("name", "shape", "possible"),
    [
        ("backlash", (0.009,), False),  # the data sheet says 5 mrad
        ("backlash", (0.011,), True),
        ("elasticity", (8.0, 0.06), False),  # and 10 Hz
        ("elasticity", (6.0, 0.06), True),
    ],
)
def test_hardly_more_than_the_owner_tells_of_is_not_missing(name, shape, possible):
    column = np.sin(np.arange(200.0))
    item = Evidence(Block(name, column[:, None], 0, 15, shape), 50.0, 400.0, 0.001, column)
    told = Facts(backlash_rad=0.005, stiffness_n_m_rad=0.02 * (20.0 * np.pi) ** 2, arm_inertia_kg_m2=0.02)
    for facts, expected in ((told, possible), (Facts(), True)):
        dataset = SimpleNamespace(effort_definition=SimpleNamespace(quantity="torque", unit="N m"), facts=facts)
        fit = SimpleNamespace(dataset=dataset, dry_friction=0.1)
        gathered: Any = SimpleNamespace(bases=[Base(np.zeros((200, 1)), column)], fit=fit, show_in="moving")
        assert (not why_not_possible(gathered, item)) == expected


@pytest.mark.parametrize(
    ("shape", "past"),
    [
        ((38.0, 0.3, 0.4), False),
        ((38.0, 0.3, 1.0), False),  # the arm may be all that turns
        ((3.0, 0.06, 0.4), False),  # at the lower ends
        ((40.0, 0.3, 0.4), True),
        ((40.0 * (1.0 - 1e-15), 0.3, 0.4), True),  # a logarithm and back may make that of 40
        ((8.0, 0.7, 0.4), True),  # nothing swings
    ],
)
def test_a_shape_at_an_upper_end_of_a_scan_goes_on_beyond_it(shape, past):
    trial = SimpleNamespace(motion=SimpleNamespace(step_s=0.01, facts=Facts()))
    gathered: Any = SimpleNamespace(fit=SimpleNamespace(dataset=SimpleNamespace(trials=[trial])))
    block = Block("elasticity", np.zeros((1, 1)), 0, 1, shape)
    assert is_past_scan(gathered, Evidence(block, 50.0, 60.0, 0.001, np.zeros(1))) == past


@pytest.mark.parametrize(("distance_rad", "before"), [(2e-4, True), (5e-4, False)])
def test_a_distance_at_the_lower_end_of_a_scan_may_be_shorter(monkeypatch, distance_rad, before):
    trial = SimpleNamespace(motion=SimpleNamespace(position_span=2.0))
    gathered: Any = SimpleNamespace(fit=SimpleNamespace(dataset=SimpleNamespace(trials=[trial])))
    block = Block("pre_sliding", np.zeros((1, 1)), 0, 1, (distance_rad,))
    item = Evidence(block, 50.0, 60.0, 0.001, np.zeros(1))
    gathered.fit.dataset.facts, gathered.fit.dataset.effort_definition = Facts(), SimpleNamespace(unit="N m")
    monkeypatch.setattr(physical, "why_not_possible", lambda *_: "")
    assert is_before_scan(gathered, item) == before
    assert bool(why_not_physical(gathered, item)) == before


@pytest.mark.parametrize(
    ("shape", "before"),
    [((0.1, 0.01), True), ((0.1, 0.02), False), ((0.3, 0.01), False)],  # a lag or a speed that is resolved tells
)
def test_a_shape_with_every_value_at_a_lower_end_may_be_of_the_measuring_chain(shape, before):
    trial = SimpleNamespace(motion=SimpleNamespace(slow=0.05, fast=2.0))
    gathered: Any = SimpleNamespace(fit=SimpleNamespace(dataset=SimpleNamespace(trials=[trial])))
    item = Evidence(Block("frictional_lag", np.zeros((1, 1)), 0, 1, shape), 50.0, 60.0, 0.001, np.zeros(1))
    assert is_before_scan(gathered, item) == before


@pytest.mark.parametrize(("excess", "possible"), [(0.02, True), (-0.02, False)])
def test_friction_that_rises_over_a_session_is_no_warm_up(excess, possible):
    column = np.exp(-np.arange(200.0) / 50.0)
    item = Evidence(Block("warm_up", column[:, None], 0, 4, (50.0,)), 50.0, 400.0, 0.001, column)
    dataset = SimpleNamespace(effort_definition=SimpleNamespace(quantity="torque", unit="N m"), facts=Facts())
    fit = SimpleNamespace(dataset=dataset, dry_friction=0.1)
    gathered: Any = SimpleNamespace(bases=[Base(np.zeros((200, 1)), excess * column)], fit=fit, show_in="sliding")
    assert (not why_not_possible(gathered, item)) == possible


BEYOND = "load beyond the gap over the load that is known"


@pytest.mark.parametrize(
    ("name", "shape", "share", "why", "badge"),
    [
        ("backlash", (0.009,), 1.0, "known from the rig (free play 0.009 rad)", "known from the rig"),
        ("backlash", (0.011,), 1.0, "", ""),
        ("backlash", (0.011,), 5.0, f"its {BEYOND} would be 5, allowed 0.3 to 3", "unphysical size"),
        ("backlash", (0.011,), -0.5, f"its {BEYOND} would be -0.5, allowed 0.3 to 3", "unphysical sign"),
        (
            "elasticity",
            (20.0, 0.7, 0.4),
            1.0,
            "its damping, of critical 0.7 is the most that it can be",
            "limit of the scan",
        ),
        (
            "pre_sliding",
            (2e-4,),
            1.0,
            "pre-sliding distance 0.0002 rad is the least that it can be",
            "limit of the scan",
        ),
        (
            "pre_sliding",
            (2e-3,),
            -1.0,
            "its friction that comes up over a distance would be -1 N m, allowed 0 or more",
            "unphysical sign",
        ),
        (
            "viscous_temperature",
            (),
            1.0,
            "its viscous friction per kelvin would be 1 N m s/(rad K), allowed 0 or less",
            "unphysical size",
        ),
        ("pre_sliding", (2e-3,), 0.01, "it would be under 50% of dry friction", "too small"),
    ],
)
def test_what_is_impossible_about_it_is_told_with_its_number(name, shape, share, why, badge):
    column = np.sin(np.arange(200.0))
    item = Evidence(Block(name, column[:, None], 0, 15, shape), 50.0, 4000.0, 0.001, column)
    told = Facts(backlash_rad=0.005)
    motion = SimpleNamespace(position_span=2.0, step_s=0.01, facts=told)
    dataset = SimpleNamespace(
        effort_definition=SimpleNamespace(quantity="torque", unit="N m"),
        facts=told,
        trials=[SimpleNamespace(motion=motion)],
    )
    fit = SimpleNamespace(dataset=dataset, dry_friction=0.1)
    gathered: Any = SimpleNamespace(bases=[Base(np.zeros((200, 1)), share * column)], fit=fit, show_in="sliding")
    assert why_not_physical(gathered, item) == why
    assert badge_of(gathered, item) == badge


@pytest.mark.parametrize(("distance_rad", "why"), [(0.2, "pre-sliding distance 0.2 rad is the most"), (0.02, "")])
def test_a_shape_of_a_fitted_model_at_an_end_of_its_scan_says_so(distance_rad, why):
    motion = SimpleNamespace(position_span=2.0)
    dataset = SimpleNamespace(
        effort_definition=SimpleNamespace(unit="N m"), facts=Facts(), trials=[SimpleNamespace(motion=motion)]
    )
    term = SimpleNamespace(effect=effect_named("pre_sliding"), shape=(distance_rad,))
    fit: Any = SimpleNamespace(terms=(term,), dataset=dataset)
    assert why_at_end(fit, "pre_sliding").startswith(why)
    assert bool(why_at_end(fit, "pre_sliding")) == bool(why)
