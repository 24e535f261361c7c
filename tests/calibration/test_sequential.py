"""The sequential design: it measures where it knows least, stops in time, and is as good as the full sweep."""

from dataclasses import replace

import numpy as np
import pytest

from bench.calibration.points import FrictionPoint
from bench.calibration.sequential import BATCH, FIRST, SequentialDesign
from bench.config.configuration import default_configuration
from compensator.motion.friction_calibration import fit
from compensator.motion.kinetic_friction import KineticFriction
from tests.calibration.accuracy import error_a, seeded, sequential

BENCH = default_configuration()
DESIGN = SequentialDesign(BENCH, (0.0, 0.1), accuracy_a=2e-3, budget_s=480.0, duties=(0.1,))
CURVE = KineticFriction(0.06, 0.1, 5.0, 2.0, 0.002)


def _points(speeds_rad_s, scatter_a=2e-3, load_kg=0.0):
    random = np.random.default_rng(1)
    return [
        FrictionPoint(
            load_kg, sign * speed, 0.0, float(sign * CURVE.sliding_a(speed) + random.normal(0.0, scatter_a)), 0.1
        )
        for speed in speeds_rad_s
        for sign in (1.0, -1.0)
    ]


def test_it_begins_with_the_whole_range_and_tells_the_motor_under_the_first_load_alone():
    first = DESIGN.next({}, {})
    assert len(first.parameters["speeds_rad_s"]) == FIRST
    assert first.parameters["duties"] == [0.1]
    second = replace(DESIGN, accuracy_a=1.0).next({0.0: _points(np.geomspace(0.6, 100.0, 10))}, {0.0: 60.0})
    assert (second.load_kg, second.parameters["duties"]) == (0.1, [])


def test_it_goes_where_the_curve_is_known_least():
    # all points but two are fast: what is not known is the rise towards rest
    points = _points([0.8, 1.5, *np.geomspace(20.0, 110.0, 10)])
    batch = DESIGN.next({0.0: points}, {0.0: 60.0})
    assert len(batch.parameters["speeds_rad_s"]) == BATCH
    assert max(batch.parameters["speeds_rad_s"]) < 20.0 / BENCH.rig.gear.ratio


def test_it_stops_where_it_knows_enough_and_where_its_time_is_up():
    sure = {load_kg: _points(np.geomspace(0.6, 110.0, 15), 1e-5, load_kg) for load_kg in (0.0, 0.1)}
    assert DESIGN.next(sure, {0.0: 60.0, 0.1: 60.0}) is None
    unsure = {load_kg: _points(np.geomspace(0.6, 110.0, 15), 1e-2, load_kg) for load_kg in (0.0, 0.1)}
    assert DESIGN.next(unsure, {0.0: 60.0, 0.1: 60.0}) is not None
    assert DESIGN.next(unsure, {0.0: 239.0, 0.1: 239.0}) is None


def test_the_interval_of_the_curve_holds_the_true_one():
    inside = []
    for seed in range(40):
        random = np.random.default_rng(seed)
        speeds = np.concatenate([sign * np.geomspace(0.6, 110.0, 15) for sign in (1.0, -1.0)])
        currents = CURVE.sliding_a(speeds) + random.normal(0.0, 2e-3, len(speeds))
        found = fit(speeds, currents)
        at = np.geomspace(1.0, 100.0, 9)
        inside.append(np.abs(found.curve.sliding_a(at) - CURVE.sliding_a(at)) <= found.half_width_a(at))
    assert 0.85 <= np.mean(inside) <= 1.0


@pytest.mark.timeout(120)
def test_it_is_as_accurate_as_the_full_sweep_in_ten_minutes_of_the_joint():
    rows, took_s = sequential(seeded(1))
    rms_a, _ = error_a(rows)
    assert rms_a < 2.0e-3  # `python -m tests.calibration.accuracy` prints both
    assert took_s < 600.0
