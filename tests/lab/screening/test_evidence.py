"""The evidence of whitened rows: of mere noise, and of noise with something in it."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import binom, f

from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import Screening, kept_evidence, screen
from compensator.lab.screening.noise import Noise

ROWS, KNOWN_FROM = 600, 59


def smooth(random: np.random.Generator, count: int) -> np.ndarray:
    return lfilter([1.0], [1.0, -0.9], random.standard_normal((count, ROWS + 50)), axis=-1)[:, 50:].T


def screened(bases: list[Base], blocks: list[Block]) -> Screening:
    return screen(bases, blocks, Noise((), KNOWN_FROM))


def problem(seed: int, planted: float = 0.0) -> tuple[list[Base], list[Block]]:
    """A base of three smooth columns, twelve candidates; `planted` times candidate 4 is in the effort."""
    random = np.random.default_rng(seed)
    columns, candidates = smooth(random, 3), smooth(random, 14)
    effort = columns @ np.array([1.0, -2.0, 0.5]) + random.standard_normal(ROWS) + planted * candidates[:, 4]
    blocks = [Block(f"c{index}", candidates[:, [index]], 0, 1) for index in range(11)]
    return [Base.of(columns, effort)], [*blocks, Block("pair", candidates[:, 11:13], 0, 1)]


def test_false_alarms_on_noise_are_as_rare_as_they_say():
    """Noise that is known from so many stretches: its own variance scatters as much."""
    sets = 100
    p_values = []
    for seed in range(sets):
        bases, blocks = problem(seed)
        known = np.random.default_rng(seed + 1000).chisquare(KNOWN_FROM) / KNOWN_FROM
        p_values.append(screened([Base(bases[0].basis, bases[0].residual / np.sqrt(known))], blocks).p_value)
    assert np.sum(np.array(p_values) <= 0.01) <= binom.ppf(0.995, sets, 0.01)
    assert np.sum(np.array(p_values) <= 0.5) >= binom.ppf(0.005, sets, 0.5)  # nor does it never alarm


@pytest.mark.parametrize(("shares", "degrees"), [((1.0, 0.0), 60.0), ((0.0, 1.0), 4.0), ((0.5, 0.5), 15.0)])
def test_a_direction_is_known_as_well_as_the_noise_that_it_has(shares, degrees):
    """Of two sources, known from 60 and from 4 squares (Satterthwaite 1946)."""
    noise = SimpleNamespace(
        freedoms=np.array([60.0, 4.0]), shares=lambda found: np.outer(shares, np.ones(found.shape[1]))
    )
    bases, blocks = problem(2, planted=0.05)
    for one in screen(bases, blocks, noise).evidence:
        direction = one.direction @ bases[0].residual
        rank = one.block.columns.shape[1]
        assert one.p_value == pytest.approx(f.sf(direction**2 / rank, rank, degrees), rel=1e-6)


def test_of_one_block_the_chance_among_all_is_its_own():
    """However few stretches tell the noise: that is in the chance of the block, and in that among all."""
    bases, blocks = problem(7)
    found = screen(bases, blocks[:1], Noise((), 5))
    assert found.chance is not None
    for own in (0.02, 0.1, 0.5):
        assert found.chance(own) == pytest.approx(own, rel=0.15)


@pytest.mark.parametrize("seed", range(5))
def test_a_planted_column_is_found_and_named(seed):
    found = screened(*problem(seed, planted=0.25))
    assert found.p_value <= 0.01
    assert found.evidence[0].block.name == "c4"
    assert found.evidence[0].score > 10.0
    assert all(item.score < found.evidence[0].score for item in found.evidence[1:])


def test_the_score_is_the_gain_in_likelihood_less_its_price():
    bases, blocks = problem(1, planted=0.25)
    base = bases[0]
    scanned = [Block("c4", blocks[4].columns, 0, 5, (1.0,))]
    one, many = (screened(bases, some).evidence[0] for some in ([blocks[4]], scanned))
    assert one.score - many.score == pytest.approx(2 * np.log(5))
    full = np.column_stack([base.basis, blocks[4].columns])
    left = base.residual - full @ np.linalg.lstsq(full, base.residual, rcond=None)[0]
    gain = ROWS * np.log((base.residual @ base.residual) / (left @ left))
    assert one.noncentrality == pytest.approx(gain)
    assert one.score == pytest.approx(gain - np.log(ROWS))
    assert one.direction @ one.direction == pytest.approx(1.0)
    assert np.abs(base.basis.T @ one.direction).max() < 1e-9
    pair = next(item for item in screened(bases, blocks).evidence if item.block.name == "pair")
    assert pair.noncentrality - pair.score == pytest.approx(2 * np.log(ROWS))


def test_what_the_base_holds_already_is_no_candidate():
    bases, blocks = problem(2)
    held = Block("held", bases[0].basis @ np.ones((3, 1)), 0, 1)
    assert screened(bases, [held]).evidence == []
    assert screened(bases, [held]).p_value == 1.0
    names = [item.block.name for item in screened(bases, [*blocks, held]).evidence]
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


def test_a_model_without_residual_has_nothing_missing():
    random = np.random.default_rng(5)
    columns = smooth(random, 3)
    base = Base.of(columns, np.zeros(ROWS))
    found = screened([base], [Block("c", smooth(random, 1), 0, 1)])
    assert all(np.isfinite(item.score) for item in found.evidence)
    assert found.p_value > 0.01
