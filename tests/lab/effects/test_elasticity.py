"""What the owner tells of the stiffness, as the frequency that the effect is fitted by."""

from dataclasses import replace

import pytest

from compensator.lab.effects.mechanics import elasticity
from compensator.lab.recordings.far_side import TOLD
from tests.lab.synthetic import FACTS

KNOWN = replace(FACTS, stiffness_n_m_rad=39.478, arm_inertia_kg_m2=0.01)  # (2 pi 10 Hz)^2 of the inertia


def test_a_stiffness_and_an_inertia_make_a_frequency():
    assert elasticity.known_hz(KNOWN) == pytest.approx(10.0, rel=1e-4)


@pytest.mark.parametrize(
    "unknown",
    [{"stiffness_n_m_rad": None}, {"arm_inertia_kg_m2": None}, {"arm_inertia_kg_m2": 0.0}, {"joint": "linear"}],
)
def test_without_either_none_is_known(unknown):
    facts = replace(KNOWN, **unknown)
    assert elasticity.known_hz(facts) is None
    assert not elasticity.told(facts, (10.0, 0.06))


def test_a_joint_that_is_about_as_stiff_as_told_or_stiffer_is_what_was_told():
    softest_hz = 10.0 / TOLD**0.5
    assert elasticity.told(KNOWN, (30.0, 0.06))
    assert elasticity.told(KNOWN, (1.01 * softest_hz, 0.06))
    assert not elasticity.told(KNOWN, (0.99 * softest_hz, 0.06))
