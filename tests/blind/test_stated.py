"""Intervals that are honest are said to be; the truth of the second plant is that of a fit of many rows."""

from dataclasses import replace

import numpy as np
import pytest

from bench.evaluation.blind.figures import figures
from bench.evaluation.blind.recorded import base_fit
from bench.evaluation.blind.result import LabAnswer, Result
from bench.evaluation.blind.second_plant import SecondJoint, recordings_of, rig_of, second_joint, true_parameters
from bench.evaluation.blind.stated import confidences
from compensator.lab.model.fit import fit_model
from compensator.lab.model.intervals import estimates
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, recordings

ANSWER = LabAnswer("nothing", (), (), False, 0.5, 0.0, 0.02)
ONE = Result("", "complete", (), (), (), ANSWER, (), None, 0.02)


def of_intervals(found: tuple[float, ...]):
    return next(one for one in figures([replace(ONE, confidences=found)]) if "intervals" in one.what)


def test_nine_in_ten_have_to_hold_the_truth():
    honest, narrow = (tuple(np.linspace(0.001, 0.999, 500) ** power) for power in (1.0, 0.25))
    assert of_intervals(honest).reached
    assert of_intervals(honest).measured == pytest.approx(0.9, abs=0.01)
    assert not of_intervals(narrow).reached
    assert not of_intervals(tuple(0.5 * one for one in honest)).reached  # nor may they be too wide
    assert not of_intervals(()).is_told


def test_the_confidence_is_that_of_the_interval_that_ends_at_the_truth():
    plans = [Plan(f"t{n}", [(0.8, 0.3, n), (0.4, 0.6, 2.0 * n)], load_kg=0.1 * (n % 3)) for n in range(9)]
    dataset = make_dataset(recordings(Joint(), Bench(duration_s=7.0), plans, seed=3), FACTS, Processing(8.0))
    fit = fit_model(dataset, ["inertia", "gravity", "offset", "coulomb", "viscous"])
    viscous = next(one for one in estimates(fit) if one.effect == "viscous")
    for edge in (viscous.low, viscous.high):
        assert confidences(fit, {("viscous", "viscous friction"): edge}) == (pytest.approx(0.95),)
    assert confidences(fit, {("viscous", "viscous friction"): viscous.value}) == (pytest.approx(0.0),)
    assert confidences(fit, {}) == ()


def complete(effort: str) -> SecondJoint:
    """A joint that hides nothing, whose effort is told so."""
    drawn = (second_joint(seed, (), (), "textbook") for seed in range(60))
    return next(one for one in drawn if one.drawn.sensors.effort == effort)


@pytest.mark.parametrize("effort", ["current", "torque", "duty"])
def test_the_truth_is_in_the_unit_of_the_effort(effort):
    joint = complete(effort)
    true = true_parameters(joint)
    found = {(one.effect, one.parameter): one.value for one in estimates(base_fit(recordings_of(joint), rig_of(joint)))}
    for name in (("inertia", "inertia"), ("gravity", "load moment scale"), ("coulomb", "Coulomb friction")):
        assert found[name] == pytest.approx(true[name], rel=0.05)
    assert found["viscous", "viscous friction"] == pytest.approx(true["viscous", "viscous friction"], rel=0.1)


def test_of_what_a_data_sheet_estimates_no_truth_is_known():
    assert true_parameters(complete("estimate")) == {}
