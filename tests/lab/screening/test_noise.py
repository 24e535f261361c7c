"""Noise that is learnt from what is left: its covariance, and chances that hold what they say."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.diagnosis.bursts import bursts_of
from compensator.lab.screening.evidence import Base, Block, screen, screen_against_noise
from compensator.lab.screening.noise import Noise

TRIALS, ROWS, PERIOD_S = 12, 120, 0.05  # 6 s each


def dataset() -> SimpleNamespace:
    """As much of a dataset as noise and bursts look at."""
    time_s = PERIOD_S * np.arange(ROWS)
    return SimpleNamespace(
        trials=tuple(range(TRIALS)),
        time_of=lambda _trial: time_s,
        trial_index=np.repeat(np.arange(TRIALS), ROWS),
        block_index=np.concatenate([3 * trial + (time_s // 2.0).astype(int) for trial in range(TRIALS)]),
    )


def coloured(random: np.random.Generator, memory: float = 0.8) -> np.ndarray:
    noise = random.standard_normal((TRIALS, ROWS + 100))
    return lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], noise)[:, 100:].ravel()


ALL = np.ones(TRIALS * ROWS, dtype=bool)


def learnt(residual: np.ndarray) -> Noise:
    return Noise.learnt(dataset(), ALL, residual, taken=1, before=float(residual @ residual))


def test_the_covariance_of_a_direction_is_what_noise_puts_into_it():
    random = np.random.default_rng(1)
    slow = np.tile(np.sin(np.linspace(0.0, np.pi, ROWS)), TRIALS)
    quick = np.tile((-1.0) ** np.arange(ROWS), TRIALS)
    directions = np.column_stack([one / np.linalg.norm(one) for one in (slow, quick)])
    shares = np.array([directions.T @ coloured(random) for _ in range(400)])
    found = np.mean([np.diag(learnt(coloured(random)).covariance(directions)) for _ in range(20)], axis=0)
    assert found == pytest.approx(shares.var(axis=0), rel=0.25)
    assert found[0] > 20.0 * found[1]


def test_rows_left_out_count_for_nothing():
    random = np.random.default_rng(2)
    rows = random.random(len(ALL)) < 0.6
    residual = coloured(random)[rows]
    noise = Noise.learnt(dataset(), rows, residual, taken=1, before=float(residual @ residual))
    whole = learnt(coloured(random))
    share = np.ones((int(rows.sum()), 1)) / np.sqrt(rows.sum())
    assert float(noise.covariance(share)[0, 0]) == pytest.approx(
        0.6 * float(whole.covariance(np.ones((len(ALL), 1)) / np.sqrt(len(ALL)))[0, 0]), rel=0.4
    )


def test_noise_alone_is_as_strong_as_its_chance_says():
    random = np.random.default_rng(3)
    blocks = [Block(str(index), coloured(random)[:, None], 0, 1) for index in range(12)]
    p_values = []
    for _ in range(150):
        base = Base.of(np.ones((len(ALL), 1)), coloured(random))
        p_values.append(screen_against_noise([base], blocks, learnt(base.residual)).p_value)
    assert np.mean(np.array(p_values) <= 0.05) <= 0.10
    assert np.mean(np.array(p_values) <= 0.5) == pytest.approx(0.5, abs=0.15)


def test_what_three_stretches_hold_is_found_where_flips_cannot():
    random = np.random.default_rng(4)
    held = np.zeros(len(ALL))
    for start in (200, 720, 1080):  # a stretch of 2 s each
        held[start : start + 20], held[start + 20 : start + 40] = 1.0, -1.0
    noise = coloured(random, 0.3)
    base = Base.of(np.ones((len(ALL), 1)), noise + 1.5 * held)
    block = Block("held", held[:, None], 0, 1)
    cleared = base.extended(held[:, None]).residual
    assert screen([base], [block], dataset().block_index).p_value > 0.01
    assert screen_against_noise([base], [block], learnt(cleared)).p_value <= 0.001


def test_bursts_are_stretches_that_scatter_more_than_the_others():
    residual = coloured(np.random.default_rng(5))
    assert not bursts_of(dataset(), residual, ALL).are_there
    residual[ROWS : ROWS + 40] *= 12.0
    found = bursts_of(dataset(), residual, ALL)
    assert (found.are_there, found.stretches, found.trials) == (True, 1, (1,))
    assert found.largest > 4.0
    burst = residual[ROWS : ROWS + 40]
    assert found.share == pytest.approx(float(burst @ burst) / float(residual @ residual))
