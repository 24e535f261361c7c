"""The simulated servo that judges models beside bam: where friction must hold it, and how a free one swings."""

import numpy as np
import pytest

from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, plans, recordings
from tests.recordings.closed_loop import Logs, simulated

EFFECTS = ("inertia", "gravity", "offset", "coulomb", "viscous")


def fitted(joint):
    return fit_model(make_dataset(recordings(joint, trials=plans((0.0,)), seed=2), FACTS, Processing()), EFFECTS)


def logs(target_rad, gain, samples=2000):
    target = np.tile(np.asarray(target_rad, dtype=float), (samples, 1))
    return Logs(target, np.zeros_like(target), np.asarray(gain, dtype=float), 10.0, 0.005)


def test_a_servo_rests_where_friction_holds_what_its_effort_lacks():
    joint = Joint(static_excess=0.0)
    targets, gain = [0.4, -0.7, 1.1], [3.0, 2.0, 4.0]
    rest = simulated(fitted(joint), logs(targets, gain))[-1]
    lacking = np.array(gain) * (np.array(targets) - rest) - joint.arm_moment * np.sin(rest) - joint.offset
    assert np.abs(lacking).max() <= 1.05 * joint.coulomb
    assert np.abs(rest - targets).max() > 0.01  # it does not reach them


def test_without_friction_it_swings_at_its_own_frequency():
    joint = Joint(coulomb=0.0, viscous=0.0, static_excess=0.0, arm_moment=0.0, offset=0.0)
    position = simulated(fitted(joint), logs([0.3], [2.0]))[:, 0]
    crossings = np.flatnonzero(np.diff(np.sign(position - 0.3)) > 0)
    period_s = float(np.mean(np.diff(crossings))) * 0.005
    assert period_s == pytest.approx(2.0 * np.pi * np.sqrt(joint.inertia / 2.0), rel=0.03)


def test_the_measure_is_the_mean_absolute_error():
    made = logs([0.0, 0.0], [1.0, 1.0], samples=10)
    assert made.mean_absolute_error_rad(np.full((10, 2), -0.2)) == pytest.approx(0.2)
