"""Samples that are old by differing times are noise of the position: no inertia gets smaller."""

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.low_pass import low_pass
from compensator.lab.recordings.position_noise import position_noise
from compensator.lab.recordings.processing import make_signals
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, recordings

RATE_HZ = 125.0
ODD = (1, 3, 5, 7, 9)  # harmonics of a triangle: quick turns, and little acceleration between


def noise_density(recording):
    """Of a recording's position, as its signals have it."""
    return make_signals(recording, choose_effort([recording], FACTS), FACTS, 5.0).position_noise


def turning(oldest_s: float):
    """Recordings of a joint that turns quickly, whose positions are 0 .. oldest_s old."""
    plans = [
        Plan(f"{hz:g} Hz", [(0.5 / n**2, hz * n, n * load_kg) for n in ODD], load_kg=load_kg)
        for hz, load_kg in ((0.5, 0.0), (0.6, 0.1), (0.7, 0.2), (0.8, 0.3))
    ]
    made = recordings(bench=Bench(rate_hz=RATE_HZ, quantum=0.0), trials=plans)
    random = np.random.default_rng(5)
    for one in made:
        time_s, position = one.channels["time_s"], one.channels["position_rad"]
        position[:] = np.interp(time_s - random.uniform(0.0, oldest_s, len(time_s)), time_s, position.copy())
    return made


@pytest.mark.parametrize("oldest_s", [0.0, 1e-3, 3e-3])
def test_inertia_is_found_behind_values_that_are_now_fresh_and_now_old(oldest_s):
    dataset = make_dataset(turning(oldest_s), FACTS, Processing())
    fit = fit_model(dataset, [*default_effects(FACTS), "measurement_delay"])
    (inertia,) = (term for term in fit.terms if term.effect.name == "inertia")
    assert inertia.coefficients[0] == pytest.approx(Joint().inertia, rel=0.03)


def test_the_noise_is_that_of_a_uniform_age_times_the_speed():
    oldest_s = 2e-3
    for one in turning(oldest_s):
        speed = np.gradient(one.channels["position_rad"], 1.0 / RATE_HZ)
        expected = oldest_s**2 / 12.0 * float(np.mean(speed**2)) * 2.0 / RATE_HZ
        assert noise_density(one) == pytest.approx(expected, rel=0.5)


def unevenly(made, jitter: float):
    """The same positions, each at a moment that is off by a share of the period, known to the recording."""
    random = np.random.default_rng(9)
    for one in made:
        time_s, position = one.channels["time_s"], one.channels["position_rad"]
        taken_s = time_s + jitter / RATE_HZ * np.clip(random.standard_normal(len(time_s)), -3.0, 3.0)
        position[:] = np.interp(taken_s, time_s, position.copy())
        time_s[:] = taken_s
    return made


def test_noise_of_samples_at_uneven_times_is_told_though_half_of_it_is_lost_between_them():
    quantum = 2e-3
    made = recordings(bench=Bench(rate_hz=RATE_HZ, quantum=0.0), trials=[Plan("wide", [(1.0, 0.31, 0.0)])])
    (one,) = unevenly(made, jitter=0.1)
    one.channels["position_rad"][:] = np.round(one.channels["position_rad"] / quantum) * quantum
    assert noise_density(one) == pytest.approx(quantum**2 / 12.0 * 2.0 / RATE_HZ, rel=0.3)


def test_counts_are_noise_of_a_twelfth_of_their_square():
    quantum = 1e-3
    made = recordings(bench=Bench(rate_hz=RATE_HZ, quantum=quantum), trials=[Plan("wide", [(1.0, 0.31, 0.0)])])
    assert noise_density(made[0]) == pytest.approx(quantum**2 / 12.0 * 2.0 / RATE_HZ, rel=0.3)


def accelerated(position):
    """Second differences of a position at RATE_HZ."""
    return np.gradient(np.gradient(position, 1.0 / RATE_HZ), 1.0 / RATE_HZ)


def test_an_acceleration_keeps_its_motion_and_loses_noise_where_there_is_only_noise():
    time_s = np.arange(0.0, 12.0, 1.0 / RATE_HZ)
    quick, steady = (time_s > 1.0) & (time_s < 5.0), (time_s > 7.0) & (time_s < 11.0)
    position = np.where(time_s < 6.0, np.sin(2.0 * np.pi * 3.0 * time_s), 2.0 * (time_s - 6.0))
    noisy = position + 1e-4 * np.random.default_rng(3).standard_normal(len(time_s))
    exact, measured = accelerated(position), accelerated(noisy)
    noise = position_noise(noisy, 0.0, RATE_HZ)
    found, drawn = noise.removed_from(measured), noise.kept
    assert rms(found[steady] - exact[steady]) < 0.4 * rms(measured[steady] - exact[steady])
    assert rms(found[quick] - exact[quick]) < 0.45 * rms(measured[quick] - exact[quick])
    # where the motion is, at 3 Hz, what is left of the noise has the size of what was drawn
    left, again = (low_pass(one, 5.0, RATE_HZ) for one in (found - exact, drawn))
    assert rms(again[quick]) == pytest.approx(rms(left[quick]), rel=0.4)
    assert found[quick] @ exact[quick] / (exact[quick] @ exact[quick]) == pytest.approx(1.0, abs=1e-3)


def test_an_acceleration_without_noise_stays_as_it_is():
    time_s = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    position = np.sin(2.0 * np.pi * 1.5 * time_s) + 0.3 * np.sin(2.0 * np.pi * 4.0 * time_s)
    exact = accelerated(position)
    inside = slice(20, -20)
    found = position_noise(position, 0.0, RATE_HZ).removed_from(exact)
    assert found[inside] == pytest.approx(exact[inside], abs=1e-3 * rms(exact))


def rms(values):
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
