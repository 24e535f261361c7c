"""How much of the inertia lies beyond the teeth, where the owner does not tell."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.mechanics import backlash, elasticity
from compensator.lab.effects.mechanics.beyond_teeth import SHARES, beyond_teeth
from compensator.lab.recordings.far_side import parting_on_a_spring
from tests.lab.effects.test_effects import motion

ALL, LOAD, SHARE, HZ, DAMPING = 0.05, 0.02, 0.4, 0.8, 0.1


def unknown():
    """A motion of a joint of which only the load's inertia is known beyond the teeth."""
    m = motion()
    return replace(m, inertia_beyond=ALL, load_inertia=LOAD, parting=np.sin(m.position) / ALL + m.acceleration)


def test_load_and_arm_lie_beyond_the_teeth_and_the_motor_does_not():
    m = unknown()
    inertia, parting = beyond_teeth(m, SHARE)
    assert inertia == pytest.approx(LOAD + SHARE * (ALL - LOAD))
    assert inertia * parting == pytest.approx(np.sin(m.position) + inertia * m.acceleration)


def test_a_load_slows_the_swing_of_the_arm_on_one_stiffness():
    stiffness = (2.0 * np.pi * HZ) ** 2 * (ALL - LOAD)
    loaded = unknown()
    bare = replace(loaded, inertia_beyond=ALL - LOAD, load_inertia=0.0)
    for m in (loaded, bare):
        inertia, parting = beyond_teeth(m, SHARE)
        lighter = np.sqrt((ALL - LOAD) / inertia)
        expected = parting_on_a_spring(parting, np.sqrt(stiffness / inertia), DAMPING * lighter, m.step_s)
        assert elasticity.columns(m, (HZ, DAMPING, SHARE))[0] == pytest.approx(-inertia * expected)


def test_on_a_flank_the_load_weighs_what_it_weighs_half_a_gap_behind():
    pushed, slope, gap = np.full(41, 3.0), np.linspace(1.0, 2.0, 41), 0.02
    on_flank = replace(unknown(), parting=pushed, acceleration=pushed, carried_slope=slope)
    assert backlash.columns(on_flank, (gap, 1.0))[0] == pytest.approx(-0.5 * gap * slope)


@pytest.mark.parametrize("effect", [backlash, elasticity])
def test_the_share_is_scanned_only_where_the_arm_is_not_told(effect):
    m = motion()
    told = replace(m, facts=replace(m.facts, arm_inertia_kg_m2=0.01))
    assert {shape[-1] for shape in effect.shapes(m)} == set(SHARES)
    assert {shape[-1] for shape in effect.shapes(told)} == {1.0}
