"""What a model leaves: more than noise, or not."""

import re
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.remaining import what_remains
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over import remainder
from compensator.lab.left_over.remainder import Remainder, remainder_of
from compensator.lab.left_over.swinging import swing_of
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather_curves
from tests.lab.left_over.judged import leaving
from tests.lab.synthetic import FACTS, Bench, Joint, Truth, plans, recordings


def fitted(extra=None, seed=0, **bench):
    made = recordings(Joint(extra=extra), Bench(**{"duration_s": 9.0, "noise_memory": 0.0, **bench}), plans(), seed)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


def left(fit):
    return remainder_of(fit.dataset, fit.residual[fit.training], fit.training)


@pytest.mark.parametrize("seed", range(4))
def test_noise_is_as_dense_in_the_band_of_the_motion_as_above(seed):
    found = left(fitted(seed=seed))
    assert found.denser == pytest.approx(1.0, abs=0.35)
    assert abs(found.certainty) < 3.0
    assert not found.is_more_than_noise


def test_what_noise_fills_of_the_motions_band_is_not_left_over():
    """Little that follows the motion, in much noise: that it is denser below says nothing of how much it is."""
    found = left(fitted(lambda x: 0.004 * np.sign(x.q - 0.4), noise=0.03))
    assert found.share > 0.01
    assert found.in_band < 0.01
    more = left(fitted(lambda x: 0.05 * np.abs(x.q - 0.4), noise=0.03))
    assert more.is_more_than_noise


def test_what_is_surely_denser_but_small_beside_the_noise_is_not_told():
    assert not Remainder(share=0.05, in_band=0.008, denser=4.0, certainty=9.0).is_more_than_noise
    assert Remainder(share=0.05, in_band=0.012, denser=4.0, certainty=9.0).is_more_than_noise


def test_coloured_noise_is_noise():
    found = left(fitted(noise_memory=0.8))
    assert found.denser > 1.0
    assert found.resonance is None
    assert not found.is_more_than_noise


def struck(x: Truth, hz: float = 3.0, damping: float = 0.15) -> np.ndarray:
    """Torque of a small mass on a spring at the arm's end, which the arm's acceleration strikes."""
    w, step_s = 2.0 * np.pi * hz, float(x.time_s[1] - x.time_s[0])
    way, speed, force = 0.0, 0.0, np.empty(len(x.time_s))
    for at, acceleration in enumerate(x.a):
        speed += step_s * (-acceleration - w**2 * way - 2.0 * damping * w * speed)
        way += step_s * speed
        force[at] = -0.004 * w**2 * way
    return force


def restless(x: Truth) -> np.ndarray:
    """Strikes of all frequencies."""
    random = np.random.default_rng(int(1e6 * abs(x.q[0])))
    return struck(replace(x, a=x.a + 5.0 * random.standard_normal(len(x.a))))


def test_what_swings_when_it_is_struck_rings_at_its_frequency():
    fit = fitted(restless, noise=0.002)
    rings = left(fit).resonance
    assert rings is not None
    assert rings.frequency_hz == pytest.approx(3.0, rel=0.15)
    assert swing_of(gather_curves(fit)) is None, "it is no line that keeps its phase"
    answer = diagnose(fit)
    assert answer.remains
    assert re.search(r"rings at about [23](\.\d)? Hz", answer.sentence)


def test_a_resonance_is_one_of_most_trials():
    fit = fitted(lambda x: restless(x) * (x.load_kg == 0.25) * (x.q[0] > 0.0), noise=0.002)
    assert left(fit).resonance is None


def test_few_powers_that_scatter_are_no_resonance():
    """A power of noise is twice its mean once in seven; each band has two here."""
    random, at_hz = np.random.default_rng(8), np.linspace(0.05, 5.4, 40)
    found = [remainder._resonance(6.0, at_hz, random.exponential(size=len(at_hz))) for _ in range(200)]
    assert sum(one is not None for one in found) <= 4


def test_what_is_left_and_rings_is_told_beside_a_name_with_its_frequency():
    fit = fitted(lambda x: restless(x) + 0.3 * x.q, noise=0.002)
    before = gather_curves(fit)
    notes = what_remains(fit_effects(fit, [*fit.names, "spring"]), before, "spring")
    (rings,) = (note for note in notes if note.code == "rings")
    assert rings.values["frequency_hz"] == pytest.approx(3.0, rel=0.15)


def test_what_follows_the_motion_is_no_noise():
    found = left(fitted(lambda x: 0.05 * np.abs(x.q - 0.4)))
    assert found.denser > 3.0
    assert found.certainty > 10.0
    assert found.is_more_than_noise


def test_less_than_friction_repeats_is_not_told():
    found = left(fitted(lambda x: 0.002 * np.abs(x.q - 0.4), noise=1e-5))
    assert found.denser > 2.0
    assert found.share < 0.01
    assert not found.is_more_than_noise


def test_a_few_wild_rows_do_not_make_it_more_than_noise():
    fit = fitted()
    residual = fit.residual[fit.training].copy()
    residual[::50] += 30.0 * residual.std()
    wild = remainder_of(fit.dataset, residual, fit.training)
    assert wild.share < 2.0 * left(fit).share
    assert not wild.is_more_than_noise


def test_friction_that_jumps_is_not_called_nothing():
    random = np.random.default_rng(3)

    def jumps(x):
        at_s, size = random.uniform(2.0, 6.0), random.choice([-0.05, 0.05])
        return size * (x.time_s > at_s) * np.sign(x.v)

    fit = fitted(jumps)
    assert left(fit).is_more_than_noise
    assert "Nothing is missing" not in diagnose(fit).sentence


@pytest.mark.parametrize("seed", range(3))
def test_noise_that_rises_with_frequency_does_not_swing(seed):
    """Time stamps that jitter: noise of the position, twice differentiated, takes the place of the residual."""
    fit = fitted()
    random = np.random.default_rng(seed)
    shaken = [np.diff(random.standard_normal(len(one.motion.time_s) + 2), 2)[None] for one in fit.dataset.trials]
    noise = fit.dataset.stack(shaken)[:, 0]
    noise *= 0.05 * np.std(fit.dataset.effort) / np.std(noise)
    found = remainder_of(fit.dataset, noise[fit.training], fit.training)
    assert found.share > 0.01
    assert not found.is_more_than_noise
    assert swing_of(leaving(fit, noise[fit.training])) is None


def test_too_few_stretches_to_name_anything_are_told_beside_what_is_left():
    random = np.random.default_rng(2)
    slow = np.convolve(random.normal(size=4000), np.ones(60), "same")

    def extra(x):
        return 0.02 * slow[: len(x.time_s)] / slow.std()

    made = recordings(Joint(extra=extra), Bench(duration_s=9.0), plans((0.0,), temperatures_c=(25.0,))[:1], seed=1)
    fit = fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))
    answer = diagnose(fit)
    assert (answer.verdict, answer.remains, answer.too_short) == ("nothing", True, True)
    assert re.match(r"[2-9] stretches of 2 s are too few to name an effect, yet what is left, .*%", answer.sentence)
