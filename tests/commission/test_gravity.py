"""Torque per current from a weight: a wrong scale of the angles shows, and so does a wrong weight."""

from math import sin

import pytest

from bench.commission.gravity import check_back_emf, weighed
from bench.commission.questions import CommissionError
from compensator.line_fit import Interval

G, LENGTH_M, LOAD_KG, TORQUE_N_M_A = 9.80665, 0.5, 0.1, 1.2


SMALL_RAD, ALL_RAD = (0.4, 0.8), (0.4, 0.8, 1.5708)


def _rows(scale: float = 1.0, own_kg_m: float = 0.0, angles_rad=ALL_RAD):
    """A load sweep whose arm really stands at `scale` times the angle that the counts say."""
    return [
        {
            "load_kg": load_kg,
            "angle_rad": angle_rad,
            "arm_angle_rad": angle_rad,
            "load_current_a": G * (load_kg * LENGTH_M + own_kg_m) * sin(scale * angle_rad) / TORQUE_N_M_A,
            "load_interval_a": [
                G * (load_kg * LENGTH_M + own_kg_m) * sin(scale * angle_rad) / TORQUE_N_M_A + side * 1e-3
                for side in (-1.0, 1.0)
            ],
            "friction_current_a": 0.1 + load_kg,
            "search_failure": "",
        }
        for load_kg in (0.0, LOAD_KG)
        for angle_rad in angles_rad
    ]


def test_torque_per_current_and_the_moment_of_the_bare_arm_are_found():
    found = weighed(_rows(own_kg_m=0.02), LOAD_KG, LENGTH_M)
    assert found.torque_n_m_a.value == pytest.approx(TORQUE_N_M_A, rel=1e-3)
    assert found.torque_n_m_a.low < TORQUE_N_M_A < found.torque_n_m_a.high
    assert found.has_own_moment
    assert found.own_moment_kg_m.value == pytest.approx(0.02, rel=0.01)
    assert found.breakaway_a == pytest.approx((0.1, 0.2))


def test_a_balanced_arm_has_no_moment():
    assert not weighed(_rows(), LOAD_KG, LENGTH_M).has_own_moment


@pytest.mark.parametrize(("scale", "angles_rad"), [(2.0, SMALL_RAD), (1.6, ALL_RAD), (0.5, ALL_RAD)])
def test_angles_that_are_not_what_the_counts_say_are_refused(scale, angles_rad):
    with pytest.raises(CommissionError, match="turned by the angle that was answered"):
        weighed(_rows(scale, angles_rad=angles_rad), LOAD_KG, LENGTH_M)


def test_a_search_without_an_estimate_is_refused_with_its_reason():
    rows = _rows()
    rows[0] |= {"load_current_a": None, "search_failure": "the joint kept moving"}
    with pytest.raises(CommissionError, match="the joint kept moving"):
        weighed(rows, LOAD_KG, LENGTH_M)


def test_a_weight_that_contradicts_the_back_emf_is_refused_and_one_that_does_not_show_is_not():
    check_back_emf(Interval(1.2, 1.19, 1.21), Interval(1.25, 1.24, 1.26))
    check_back_emf(Interval(1.2, 1.19, 1.21), Interval(3.0, 2.9, 3.1, "hardly shows"))
    with pytest.raises(CommissionError, match=r"weight says 2\.4 N m/A.*back-EMF 1\.25 V s/rad"):
        check_back_emf(Interval(2.4, 2.38, 2.42), Interval(1.25, 1.24, 1.26))
