"""A position sensor that misreads: columns are made of where the joint is, not of where it seems to be."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model, with_coefficients
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import at_true_position
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset, more_trials
from compensator.lab.rows.dataset import Dataset, Processing
from tests.lab.synthetic import FACTS, Bench, Joint, recordings

TURNS, SLOPE = 12.0, 0.15  # of the encoder per turn of the joint; of what it misreads
AMPLITUDE = SLOPE / TURNS
NOISE = 0.002
GEARED = replace(FACTS, gear_ratio=TURNS)
DEFAULT = default_effects(FACTS)
EXACT = recordings(Joint(), Bench(noise=NOISE, quantum=0.0), seed=5)


def misread(one: Recording) -> Recording:
    """The same, read by an encoder off its centre."""
    position = one.channels["position_rad"]
    read = position + AMPLITUDE * np.sin(TURNS * position)
    return replace(one, channels={**one.channels, "position_rad": read})


def rows(recorded: list[Recording]) -> Dataset:
    return make_dataset(recorded, GEARED, Processing(cutoff_hz=8.0))


@pytest.fixture(scope="module")
def fitted() -> Fit:
    return fit_model(rows([misread(one) for one in EXACT]), [*DEFAULT, "encoder_eccentricity"])


def test_what_is_misread_has_its_size(fitted):
    cosine, sine, *by_speed = fitted.terms[-1].coefficients
    assert (cosine, sine) == pytest.approx((0.0, -AMPLITUDE), abs=0.03 * AMPLITUDE)
    assert by_speed == pytest.approx([0.0, 0.0], abs=2e-4)


def test_the_joint_is_where_it_is(fitted):
    for trial, one in zip(fitted.dataset.trials, EXACT, strict=True):
        true = np.interp(trial.signals.time_s, one.channels["time_s"], one.channels["position_rad"])[trial.picked]
        assert np.abs(trial.motion.position[trial.picked] - true).max() < 0.1 * AMPLITUDE


def test_no_more_is_left_than_of_a_joint_that_is_read_exactly(fitted):
    exact = fit_model(rows(EXACT), DEFAULT)
    assert held_out(fitted).rms == pytest.approx(held_out(exact).rms, rel=0.1)


def test_a_model_without_it_is_fitted_to_what_is_read(fitted):
    plain = fit_effects(fitted, DEFAULT)
    for trial in plain.dataset.trials:
        assert trial.motion.position is trial.signals.position
    alone = fit_model(fitted.dataset.as_read(), DEFAULT)
    assert plain.coefficients == pytest.approx(alone.coefficients)


def test_the_position_is_corrected_once(fitted):
    assert at_true_position(fitted.dataset, fitted.terms) is fitted.dataset


@pytest.mark.parametrize("amplitude", [0.0, 1.0 / TURNS])
def test_nothing_is_corrected_by_nothing_nor_by_what_no_sensor_does(fitted, amplitude):
    count = len(fitted.coefficients)
    changed = with_coefficients(fitted, np.where(np.arange(count) >= count - 4, amplitude, fitted.coefficients))
    assert changed.dataset.trials[0].motion.position is changed.dataset.trials[0].signals.position


def test_other_trials_are_corrected_by_the_same(fitted):
    more = replace(fitted, dataset=more_trials(fitted.dataset, [misread(EXACT[2])]))
    assert np.all(more.dataset.trials[0].motion.position == more.dataset.trials[0].signals.position)
    there = at_true_position(more.dataset, fitted.terms).trials[0].motion
    assert there.position == pytest.approx(fitted.dataset.trials[2].motion.position, abs=1e-5)
    assert there.velocity == pytest.approx(fitted.dataset.trials[2].motion.velocity, abs=2e-3)


def test_what_goes_round_more_often_is_found_where_the_joint_is():
    """Guessed to be twice a turn, an angle that is misread once leaves most of itself, which goes round as well."""
    made = recordings(Joint(extra=lambda x: 0.01 * np.cos(6.0 * TURNS * x.q)), Bench(noise=NOISE, quantum=0.0), seed=5)
    fit = fit_model(rows([misread(one) for one in made]), [*DEFAULT, "encoder_eccentricity", "cogging"])
    assert fit.shapes["encoder_eccentricity"] == (TURNS,)
    assert fit.shapes["cogging"] == (6.0 * TURNS,)
