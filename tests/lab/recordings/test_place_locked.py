"""Ripple that goes by the place of the joint: how fast it is, where it comes again in every pass."""

import numpy as np
import pytest

from compensator.lab.recordings.bandwidth import choose_cutoff_hz
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.place_locked import place_locked_hz
from compensator.lab.recordings.recording import Recording

RATE_HZ, TURN_HZ = 200.0, 0.1


def turning(seed: int, order: int, ripple: float, speed: float = TURN_HZ, wobble: float = 0.0) -> Recording:
    """Slow turning one way over three turns, with a ripple of one order and noise."""
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, 3.0 / speed, 1.0 / RATE_HZ)
    position = 2.0 * np.pi * speed * (time_s + wobble * np.sin(2.0 * np.pi * speed * time_s))
    current = 0.5 + ripple * np.cos(order * position + 0.3) + 0.2 * random.standard_normal(len(time_s))
    channels = {"time_s": time_s, "position_rad": position, "current_a": current}
    return Recording(f"turn {seed}", "slow", {}, channels)


def locked_hz(trials: list[Recording]) -> float:
    return place_locked_hz(trials, choose_effort(trials, Facts()), Facts())


@pytest.mark.parametrize("order", [7, 36])
def test_the_frequency_is_that_of_the_order(order: int) -> None:
    trials = [turning(seed, order, 0.5) for seed in range(3)]
    assert locked_hz(trials) == pytest.approx(order * TURN_HZ, rel=0.02)


def test_noise_alone_is_no_order() -> None:
    assert [locked_hz([turning(seed + 10 * n, 7, 0.0) for seed in range(3)]) for n in range(20)] == [0.0] * 20


def test_speeds_that_change_within_a_turn_do_not_count() -> None:
    assert locked_hz([turning(seed, 20, 0.5, wobble=1.5) for seed in range(3)]) == 0.0


def test_a_short_fall_at_the_start_hides_nothing() -> None:
    trials = [turning(seed, 12, 0.5) for seed in range(3)]
    for trial in trials:
        trial.channels["position_rad"][:20] += np.linspace(9.0, 0.0, 20)
    assert locked_hz(trials) == pytest.approx(12 * TURN_HZ, rel=0.02)


def test_the_filter_lets_the_ripple_through() -> None:
    trials = [turning(seed, 36, 0.5) for seed in range(3)]
    plain = [turning(seed, 36, 0.0) for seed in range(3)]
    assert choose_cutoff_hz(trials, choose_effort(trials, Facts()), Facts()) > 1.2 * 36 * TURN_HZ
    assert choose_cutoff_hz(plain, choose_effort(plain, Facts()), Facts()) < 36 * TURN_HZ
