"""Noise that is learnt beside what is missing: what pays is taken off, what only looks slow is not."""

from types import SimpleNamespace

import numpy as np

from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import noise_of
from compensator.lab.screening.evidence import most_likely
from compensator.lab.screening.gathering import with_noise
from compensator.lab.screening.noise import Noise
from tests.lab.screening.test_noise import ALL, NOTHING, ROWS, STEADY, TRIALS, coloured, dataset

BLOCKS, SHAPES = 100, 20  # as many as a catalogue has, and one of its effects


class Model:
    """As much of candidates as clearing looks at; remembers by which blocks its rows were cleared."""

    def __init__(self, bases: list[Base], named: list[Block], taken: tuple[str, ...] = ()) -> None:
        self.bases, self.named, self.taken = bases, named, taken
        self.curves = SimpleNamespace(blocks=[])
        self.fit = SimpleNamespace(dataset=dataset(STEADY), terms=(), coefficients=np.zeros(0))
        self.rows, self.weights = ALL, np.ones(len(ALL))
        self.made: list[Model] = []

    def with_block(self, block: Block) -> "Model":
        other = Model([base.extended(block.columns) for base in self.bases], self.named, (*self.taken, block.name))
        self.made.append(other)
        return other

    def evened(self, noise: Noise) -> Noise:
        return noise


def slow_curves() -> list[Block]:
    at = (np.arange(ROWS) + 0.5) / ROWS
    return [Block(f"slow {order}", np.tile(np.cos(np.pi * order * at), TRIALS)[:, None], 0, 1) for order in range(1, 5)]


def quick() -> np.ndarray:
    return np.tile(np.sin(0.7 * np.pi * np.arange(ROWS)), TRIALS)


def test_slow_noise_stays_noise():
    """Quick noise hides from a lag of one row how slow the rest is: a slow curve seems to pay."""
    cleared = []
    for seed in range(24):
        random = np.random.default_rng(seed)
        noise = coloured(random, 0.95) + random.standard_normal(len(ALL))
        model = Model([Base.of(NOTHING, noise)], slow_curves())
        if most_likely(model.bases, model.named) is not None:
            kept = noise_of(model, model).autocovariances
            cleared.append(not np.array_equal(with_noise(model).autocovariances, kept))
    assert len(cleared) > 8  # else this test shows nothing
    assert np.mean(cleared) <= 0.2


def test_what_is_surely_missing_is_no_noise():
    noise = coloured(np.random.default_rng(5))
    missing = Block("missing", quick()[:, None], 0, 1)
    direction = quick()[:, None] / np.linalg.norm(quick())
    model = Model([Base.of(NOTHING, noise + 0.7 * quick())], [missing, *slow_curves()])
    known = with_noise(model)
    assert model.made[0].taken == ("missing",)
    complete = with_noise(Model([Base.of(NOTHING, noise)], [])).covariance(direction)[0, 0]
    assert known.covariance(direction)[0, 0] < 3.0 * complete


def test_no_more_than_one_is_taken_off():
    noise = coloured(np.random.default_rng(6), 0.3)
    tones = [np.tile(np.sin(rate * np.pi * np.arange(ROWS)), TRIALS) for rate in (0.3, 0.5, 0.7)]
    blocks = [Block(str(index), tone[:, None], 0, 1) for index, tone in enumerate(tones)]
    model = Model([Base.of(NOTHING, noise + np.sum(tones, axis=0))], blocks)
    with_noise(model)
    (first,) = model.made
    assert len(first.taken) == 1
    assert not first.made
