"""What is commonly done instead, on the same columns: plain F-tests, stepwise BIC, sequential thresholding.

All are given the lab's own filtered, weighted columns, its base model and its shapes, which flatters them.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.stats import f as f_distribution

from bench.evaluation.blind import sindy
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates

SIGNIFICANT = 0.05
MOST = 3  # effects that a stepwise search may add
THRESHOLDS = np.geomspace(0.01, 1.0, 12)

Rival = Callable[[Candidates], tuple[str, ...]]
"""Names what is missing, best first; nothing where nothing is."""

Solve = Callable[[FloatArray, FloatArray, float], FloatArray]
"""(unit columns, residual, threshold) -> sparse coefficients."""


def plain_f(gathered: Candidates) -> tuple[str, ...]:
    """The smallest p of an F-test for each block, Bonferroni over all of them."""
    best, lowest = "", 1.0
    for block in gathered.named:
        columns, residual = _projected(gathered, block)
        p_value = _f_test(columns, residual, _parameters(gathered, block))
        if p_value <= lowest:
            best, lowest = block.name, p_value
    return (best,) if lowest * len(gathered.named) <= SIGNIFICANT else ()


def stepwise_bic(gathered: Candidates) -> tuple[str, ...]:
    """Forward selection while the Bayesian information criterion falls."""
    named: list[str] = []
    while len(named) < MOST:
        scored = [(_bic_change(gathered, block), block) for block in gathered.named if block.name not in named]
        change, block = min(scored, key=lambda item: item[0])
        if change >= 0.0:
            break
        named.append(block.name)
        gathered = gathered.with_block(block)
    return tuple(named)


def thresholded(gathered: Candidates, solve: Solve) -> tuple[str, ...]:
    """All columns at once, small coefficients thrown out; the threshold by the Bayesian information criterion."""
    blocks = _best_shapes(gathered)
    parts = [_projected(gathered, block)[0] for block in blocks]
    residual = gathered.bases[0].residual
    columns = np.column_stack([part / np.maximum(np.linalg.norm(part, axis=0), 1e-300) for part in parts])
    owner = np.repeat(np.arange(len(blocks)), [part.shape[1] for part in parts])
    scale = float(np.linalg.norm(residual))
    tried = [solve(columns, residual, threshold * scale) for threshold in THRESHOLDS]
    best = min(tried, key=lambda coefficients: _bic(columns, residual, coefficients))
    weight = [float(np.linalg.norm(best[owner == index])) for index in range(len(blocks))]
    order = np.argsort(weight)[::-1]
    return tuple(blocks[index].name for index in order if weight[index] > 0.0)


def _stlsq(columns: FloatArray, residual: FloatArray, threshold: float) -> FloatArray:
    kept = np.ones(columns.shape[1], dtype=bool)
    coefficients = np.zeros(columns.shape[1])
    for _ in range(columns.shape[1]):
        coefficients[:] = 0.0
        if kept.any():
            coefficients[kept] = np.linalg.lstsq(columns[:, kept], residual, rcond=1e-9)[0]
        small = kept & (np.abs(coefficients) < threshold)
        if not small.any():
            break
        kept &= ~small
    return coefficients


def _rivals() -> dict[str, Rival]:
    """Those that can be asked here: thresholding by pysindy where it is installed, else by the few lines above."""
    solvers: dict[str, Solve] = {"STLSQ": _stlsq}
    if sindy.is_installed():
        solvers = {f"pysindy {name}": partial(sindy.coefficients_of, name) for name in sindy.OPTIMIZERS}
    sparse = {f"{name} with BIC": partial(thresholded, solve=solve) for name, solve in solvers.items()}
    return {"plain F-tests": plain_f, "stepwise BIC": stepwise_bic, **sparse}


RIVALS: dict[str, Rival] = _rivals()


def _projected(gathered: Candidates, block: Block) -> tuple[FloatArray, FloatArray]:
    base = gathered.bases[block.base]
    return block.columns - base.basis @ (base.basis.T @ block.columns), base.residual


def _parameters(gathered: Candidates, block: Block) -> int:
    return int(gathered.bases[block.base].basis.shape[1])


def _explained(columns: FloatArray, residual: FloatArray) -> tuple[float, int]:
    basis = orthonormal(columns)
    share = basis.T @ residual
    return float(share @ share), basis.shape[1]


def _f_test(columns: FloatArray, residual: FloatArray, parameters: int) -> float:
    explained, rank = _explained(columns, residual)
    freedom = len(residual) - parameters - rank
    left = float(residual @ residual) - explained
    if rank == 0 or freedom <= 0 or left <= 0.0:
        return 1.0
    return float(f_distribution.sf(explained / rank / (left / freedom), rank, freedom))


def _bic_change(gathered: Candidates, block: Block) -> float:
    columns, residual = _projected(gathered, block)
    explained, rank = _explained(columns, residual)
    share = min(explained / float(residual @ residual), 1.0 - 1e-12)
    return float(len(residual) * np.log1p(-share) + rank * np.log(len(residual))) if rank else 0.0


def _best_shapes(gathered: Candidates) -> list[Block]:
    best: dict[str, tuple[float, Block]] = {}
    for block in gathered.named:
        explained = _explained(*_projected(gathered, block))[0]
        if explained >= best.get(block.name, (0.0, block))[0]:
            best[block.name] = (explained, block)
    return [block for _, block in best.values()]


def _bic(columns: FloatArray, residual: FloatArray, coefficients: FloatArray) -> float:
    left = residual - columns @ coefficients
    count = int(np.count_nonzero(coefficients))
    return float(len(left) * np.log(max(float(left @ left), 1e-300)) + count * np.log(len(left)))
