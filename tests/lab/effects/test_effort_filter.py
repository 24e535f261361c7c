"""Effort that a drive or a logger has smoothed: found beside a delay, its time constant with it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.search import search
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.effects.test_effects import motion
from tests.lab.synthetic import FACTS, recordings

MODEL = (*default_effects(FACTS), "measurement_delay")


def smoothed(one: Recording, time_constant_s: float) -> Recording:
    """The recording as a drive would report it that smooths its current."""
    kept = np.exp(-1.0 / 200.0 / time_constant_s)
    torque = one.channels["torque_n_m"]
    reported, _ = lfilter([1.0 - kept], [1.0, -kept], torque, zi=kept * torque[:1])
    return replace(one, channels={**one.channels, "torque_n_m": reported})


@pytest.mark.parametrize("time_constant_s", [0.06, 0.2])
def test_it_is_named_beside_a_delay_and_its_time_constant_is_found(time_constant_s):
    made = [smoothed(one, time_constant_s) for one in recordings(seed=3)]
    dataset = make_dataset(made, FACTS, Processing(8.0))
    fit = fit_model(dataset, MODEL)
    found = diagnose(fit)
    assert (found.verdict, found.candidates[0].effect.name) == ("missing", "effort_filter"), found.sentence
    filled = fit_model(dataset, [*MODEL, "effort_filter"])
    share, (found_s,) = filled.terms[-1].coefficients[0], filled.shapes["effort_filter"]
    assert share * found_s == pytest.approx(time_constant_s, rel=0.15)  # what passes slowly is late by that
    assert np.std(filled.residual[dataset.counted]) < 0.6 * np.std(fit.residual[dataset.counted])


def test_a_delay_alone_is_no_filter():
    made = recordings(seed=4)
    late = [
        replace(one, channels={**one.channels, "torque_n_m": np.roll(one.channels["torque_n_m"], 4)}) for one in made
    ]
    found = diagnose(fit_model(make_dataset(late, FACTS, Processing(8.0)), MODEL))
    assert found.verdict != "missing" or found.candidates[0].effect.name != "effort_filter", found.sentence


@pytest.mark.parametrize("time_constant_s", [0.02, 0.1])
def test_it_is_found_without_a_delay_that_would_stand_for_a_part_of_it(time_constant_s):
    made = [smoothed(one, time_constant_s) for one in recordings(seed=3)]
    found = search(fit_model(make_dataset(made, FACTS, Processing(8.0)), default_effects(FACTS)))
    assert found.added == ("effort_filter",)


def late(delay_s: float) -> Fit:
    """The plain model of recordings whose effort is late."""
    made = []
    for one in recordings(seed=5):
        time_s, torque = one.channels["time_s"], one.channels["torque_n_m"]
        made.append(replace(one, channels={**one.channels, "torque_n_m": np.interp(time_s - delay_s, time_s, torque)}))
    return fit_model(make_dataset(made, FACTS, Processing(8.0)), default_effects(FACTS))


def test_a_long_delay_is_taken_out_whole():
    """To first order alone it would leave as much as a small effect does."""
    kept, moved = late(0.0), late(0.03)
    found = search(moved)
    assert found.added == ("measurement_delay",)
    assert found.fit.terms[-1].coefficients[0] == pytest.approx(-0.03, rel=0.1)
    left, before = (np.std(fit.residual[fit.training]) for fit in (found.fit, kept))
    assert left < 1.3 * before


def test_a_part_of_a_sample_is_no_delay_that_is_missing():
    assert diagnose(late(0.001)).verdict == "nothing"


def test_a_trial_begins_settled():
    effect, moment = effect_named("effort_filter"), replace(motion(), predicted=np.full(41, 0.7))
    assert effect.columns(moment, (0.1,)) == pytest.approx(np.zeros((1, 41)), abs=1e-12)
