"""The robust p-value on mere autocorrelated noise, and on noise with something in it."""

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import binom

from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import kept_evidence, screen

ROWS, STRETCHES = 600, 60
STRETCH = np.repeat(np.arange(STRETCHES), ROWS // STRETCHES)


def coloured(random: np.random.Generator, count: int, memory: float = 0.5) -> np.ndarray:
    return lfilter([1.0], [1.0, -memory], random.standard_normal((count, ROWS + 50)), axis=-1)[:, 50:].T


def problem(seed: int, planted: float = 0.0) -> tuple[list[Base], list[Block]]:
    """A base of three smooth columns, twelve candidates; `planted` times candidate 4 is in the effort."""
    random = np.random.default_rng(seed)
    columns, candidates = coloured(random, 3, 0.9), coloured(random, 14, 0.9)
    effort = columns @ np.array([1.0, -2.0, 0.5]) + coloured(random, 1)[:, 0] + planted * candidates[:, 4]
    blocks = [Block(f"c{index}", candidates[:, [index]], 0, 1) for index in range(11)]
    return [Base.of(columns, effort)], [*blocks, Block("pair", candidates[:, 11:13], 0, 1)]


def test_false_alarms_on_autocorrelated_noise_are_as_rare_as_they_say():
    sets = 100
    p_values = np.array([screen(*problem(seed), STRETCH, seed).p_value for seed in range(sets)])
    assert np.sum(p_values <= 0.01) <= binom.ppf(0.995, sets, 0.01)
    assert np.sum(p_values <= 0.5) >= binom.ppf(0.005, sets, 0.5)  # nor does it never alarm


@pytest.mark.parametrize("seed", range(5))
def test_a_planted_column_is_found_and_named(seed):
    found = screen(*problem(seed, planted=0.25), STRETCH)
    assert found.p_value <= 0.01
    assert found.evidence[0].block.name == "c4"
    assert found.evidence[0].score > 10.0
    assert all(item.score < found.evidence[0].score for item in found.evidence[1:])


def test_the_score_is_the_gain_in_likelihood_less_its_price():
    bases, blocks = problem(1, planted=0.25)
    base = bases[0]
    scanned = [Block("c4", blocks[4].columns, 0, 5, (1.0,))]
    one, many = (screen(bases, some, STRETCH).evidence[0] for some in ([blocks[4]], scanned))
    assert one.score - many.score == pytest.approx(2 * np.log(5))
    full = np.column_stack([base.basis, blocks[4].columns])
    left = base.residual - full @ np.linalg.lstsq(full, base.residual, rcond=None)[0]
    residual = base.residual
    r = residual[:-1] @ residual[1:] / (residual @ residual)
    inflation = (1 + r) / (1 - r)
    gain = ROWS * np.log((residual @ residual) / (left @ left)) / inflation
    assert one.noncentrality == pytest.approx(gain)
    assert one.score == pytest.approx(gain - np.log(ROWS / inflation))
    assert one.direction @ one.direction == pytest.approx(1.0)
    assert np.abs(base.basis.T @ one.direction).max() < 1e-9
    pair = next(item for item in screen(bases, blocks, STRETCH).evidence if item.block.name == "pair")
    assert pair.noncentrality - pair.score == pytest.approx(2 * np.log(ROWS / inflation))


def test_what_the_base_holds_already_is_no_candidate():
    bases, blocks = problem(2)
    held = Block("held", bases[0].basis @ np.ones((3, 1)), 0, 1)
    assert screen(bases, [held], STRETCH).evidence == []
    assert screen(bases, [held], STRETCH).p_value == 1.0
    names = [item.block.name for item in screen(bases, [*blocks, held], STRETCH).evidence]
    assert "held" not in names
    assert len(names) == len(blocks)


def test_evidence_that_is_kept_once_another_is_in_the_model():
    bases, blocks = problem(3, planted=0.5)
    twin = Block("twin", blocks[4].columns + 0.1 * blocks[5].columns, 0, 1)
    before = kept_evidence(bases, [blocks[4], twin])
    basis = np.column_stack([bases[0].basis, blocks[4].columns])
    after = kept_evidence([Base.of(basis, bases[0].residual)], [blocks[4], twin])
    assert before["twin"] > 50
    assert after["c4"] == pytest.approx(0.0, abs=1e-9)
    assert after["twin"] < 0.1 * before["twin"]


def test_one_stretch_alone_proves_nothing():
    bases, blocks = problem(4)
    spike = np.zeros(ROWS)
    spike[STRETCH == 7] = 5.0 * np.sign(blocks[0].columns[STRETCH == 7, 0])
    base = Base.of(bases[0].basis, bases[0].residual + spike)
    assert screen([base], blocks[:1], STRETCH).p_value > 0.01


def test_a_model_without_residual_has_nothing_missing():
    random = np.random.default_rng(5)
    columns = coloured(random, 3)
    base = Base.of(columns, np.zeros(ROWS))
    found = screen([base], [Block("c", coloured(random, 1), 0, 1)], STRETCH)
    assert all(np.isfinite(item.score) for item in found.evidence)
    assert found.p_value > 0.01
