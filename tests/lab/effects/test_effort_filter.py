"""Effort that a drive or a logger has smoothed: found beside a delay, its time constant with it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import candidates, default_effects, effect_named
from compensator.lab.model.fit import fit_model
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


def test_it_is_looked_for_once_a_delay_is_in_the_model():
    assert "effort_filter" not in {one.name for one in candidates(default_effects(FACTS), FACTS)}
    assert "effort_filter" in {one.name for one in candidates(MODEL, FACTS)}


def test_a_trial_begins_settled():
    effect, moment = effect_named("effort_filter"), replace(motion(), predicted=np.full(41, 0.7))
    assert effect.columns(moment, (0.1,)) == pytest.approx(np.zeros((1, 41)), abs=1e-12)
