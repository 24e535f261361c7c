"""Noise that is learnt beside what is missing: what pays is taken off, what only looks slow is not."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from compensator.lab.screening import gathering
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import Candidates, Curves
from compensator.lab.screening.evidence import most_likely
from compensator.lab.screening.gathering import with_noise
from tests.lab.screening.test_noise import ALL, NOTHING, ROWS, STEADY, TRIALS, coloured, covariance, dataset


@pytest.fixture(autouse=True)
def no_model(monkeypatch):
    monkeypatch.setattr(gathering, "_random_effects", lambda _: [])


def candidates(effort: np.ndarray, named: list[Block]) -> Candidates:
    """Beside a model of nothing."""
    fit = cast(Any, SimpleNamespace(dataset=dataset(STEADY)))
    base = Base.of(NOTHING, effort)
    return Candidates(fit, "sliding", ALL, np.ones(len(ALL)), [base], named, Curves(dict, np.asarray), {})


def cleared(monkeypatch, model: Candidates) -> tuple[Candidates, int]:
    """The candidates with their noise, and how many columns were taken off before it was learnt."""
    columns, learn = [], gathering._noise_of

    def learnt(left, random):
        columns.append(left.bases[0].basis.shape[1])
        return learn(left, random)

    with monkeypatch.context() as patched:
        patched.setattr(gathering, "_noise_of", learnt)
        return with_noise(model), columns[-1]


def slow_curves() -> list[Block]:
    at = (np.arange(ROWS) + 0.5) / ROWS
    return [Block(f"slow {order}", np.tile(np.cos(np.pi * order * at), TRIALS)[:, None], 0, 1) for order in range(1, 5)]


def quick() -> np.ndarray:
    return np.tile(np.sin(0.7 * np.pi * np.arange(ROWS)), TRIALS)


def test_slow_noise_stays_noise(monkeypatch):
    """Quick noise hides from a lag of one row how slow the rest is: a slow curve seems to pay."""
    taken = []
    for seed in range(24):
        random = np.random.default_rng(seed)
        model = candidates(coloured(random, 0.95) + random.standard_normal(len(ALL)), slow_curves())
        if most_likely(model.bases, model.named) is not None:
            taken.append(cleared(monkeypatch, model)[1] > 0)
    assert len(taken) > 8  # else this test shows nothing
    assert np.mean(taken) <= 0.2


def test_what_is_surely_missing_is_no_noise(monkeypatch):
    noise = coloured(np.random.default_rng(5))
    missing = Block("missing", quick()[:, None], 0, 1)
    direction = quick()[:, None] / np.linalg.norm(quick())
    known, taken = cleared(monkeypatch, candidates(noise + 0.7 * quick(), [missing, *slow_curves()]))
    complete, none = cleared(monkeypatch, candidates(noise, []))
    assert (taken, none) == (1, 0)
    assert known.noise is not None
    assert complete.noise is not None
    assert covariance(known.noise, direction)[0, 0] < 3.0 * covariance(complete.noise, direction)[0, 0]


def test_no_more_than_one_is_taken_off(monkeypatch):
    noise = coloured(np.random.default_rng(6), 0.3)
    tones = [np.tile(np.sin(rate * np.pi * np.arange(ROWS)), TRIALS) for rate in (0.3, 0.5, 0.7)]
    blocks = [Block(str(index), tone[:, None], 0, 1) for index, tone in enumerate(tones)]
    assert cleared(monkeypatch, candidates(noise + np.sum(tones, axis=0), blocks))[1] == 1
