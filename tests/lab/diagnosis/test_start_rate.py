"""Static friction that falls with the rate of the effort shows in slow sliding after a start, too."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.effects.friction.memory.rate_dependent_breakaway import columns
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.reversals import REST_S, start_rate
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.effects.test_effects import motion
from tests.lab.ramps import HORIZONTAL

RATE_HZ = 200.0
INERTIA, COULOMB, VISCOUS, STATIC, FILM_RAD_S = 0.02, 0.05, 0.03, 0.1, 0.3
RATES = np.geomspace(0.1, 2.0, 8)  # N m/s
BASE = ("inertia", "offset", "coulomb", "viscous", "stribeck")


def trial(seed: int, fall: float) -> Recording:
    """Ramps from rest at rates in any order, each followed by a stroke that begins and ends softly, to and fro."""
    random = np.random.default_rng(seed)
    effort, speed = [np.zeros(100)], [np.zeros(100)]
    for number, rate in enumerate(random.permutation(RATES)):
        way = (-1.0) ** number
        level = STATIC * (1.0 - fall * (rate / (rate + 0.3) - 0.5))
        rise = np.arange(0.0, level, rate / RATE_HZ)
        most = random.uniform(0.4, 1.2)
        stroke_s = np.pi * np.sqrt(2.0 * INERTIA * most / rate)  # the effort goes on at its rate
        velocity = most * np.sin(np.pi * np.arange(0.0, 1.0, 1.0 / (stroke_s * RATE_HZ))) ** 2
        friction = COULOMB + (level - COULOMB) * np.exp(-velocity / FILM_RAD_S) + VISCOUS * velocity
        rest = np.zeros(int(RATE_HZ * np.exp(random.uniform(-1.0, 1.5))))  # whatever the rate
        effort += [rest, way * rise, way * (friction + INERTIA * np.gradient(velocity, 1.0 / RATE_HZ))]
        speed += [rest, 0.0 * rise, way * velocity]
    torque, whole = np.concatenate(effort), np.concatenate(speed)
    channels = {
        "time_s": np.arange(len(whole)) / RATE_HZ,
        "position_rad": cumulative_trapezoid(whole, dx=1.0 / RATE_HZ, initial=0.0),
        "torque_n_m": torque + 1e-3 * random.standard_normal(len(torque)),
    }
    return Recording(f"ramps-{seed}", "ramps", {}, channels)


def found(fall: float) -> Diagnosis:
    dataset = make_dataset([trial(seed, fall) for seed in range(12)], HORIZONTAL, Processing(cutoff_hz=12.0))
    return diagnose(fit_model(dataset, BASE))


def test_the_rate_is_that_of_the_last_moment_at_rest():
    rate_hz, slope = 100.0, 3.0
    count = round(REST_S * rate_hz)
    time_s = np.arange(40) / rate_hz
    effort = np.where(time_s < 0.2, slope * time_s, 7.0)
    velocity = np.where((time_s >= 0.2) & (time_s < 0.3), -0.5, 0.0)
    found = start_rate(effort, velocity, rate_hz, slow=0.1)
    assert np.isnan(found[:count]).all()
    assert found[count:30] == pytest.approx(slope)  # and is kept while the joint moves
    assert found[36:] == pytest.approx(0.0)
    assert np.isnan(start_rate(effort, np.ones(40), rate_hz, slow=0.1)).all()


def test_a_start_at_the_usual_rate_has_the_usual_friction():
    as_usual = motion().having(start_rate=0.8 * np.ones(41))
    never_stood = motion().having(start_rate=np.nan, usual_start_rate=np.nan)
    for one in (as_usual, never_stood):
        assert not columns(one, (0.3,)).any()
        assert columns(one, (0.3,)).shape == (1, 41)


def test_it_is_named_by_slow_sliding_with_the_speed_that_it_is_lost_over():
    diagnosis = found(fall=0.6)
    first = diagnosis.candidates[0]
    assert (diagnosis.verdict, first.effect.name, first.rows) == ("missing", "rate_dependent_breakaway", "sliding")
    assert first.shape[0] == pytest.approx(FILM_RAD_S, rel=0.3)
    assert first.gain.low > 0.0


def test_the_same_static_friction_at_all_rates_is_no_effect_of_them():
    diagnosis = found(fall=0.0)
    assert diagnosis.verdict == "nothing", diagnosis.sentence
