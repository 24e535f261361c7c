"""What a diagnosis could know at best: the fit of the model with the truth in it, and how far the truth stands out.

r = rms of what the base model cannot absorb of the effect / rms of what the true model leaves
lambda = n / v ln(1 + r^2),   v = rows per independent row, from what the true model leaves
d' = sqrt(lambda (1 - rho^2)), rho the largest projected correlation with any other effect of the catalogue
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bench.evaluation.blind.result import Standing
from compensator.lab.at_rest.breakaway_regression import fit_breakaway
from compensator.lab.at_rest.breakaway_rows import enough_starts
from compensator.lab.diagnosis.breakaway_family import breakaway_blocks
from compensator.lab.effects.catalogue import candidates, effect_named
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import Candidates

NEEDED = 25.6  # noncentrality that 64 candidates at 1 % need for 90 % power


def standing(gathered: Candidates, name: str) -> Standing | None:
    """How far an effect stands out of a model without it; None where these trials cannot show it at all."""
    return _standing_among(gathered.bases, gathered.named, name)


def standing_at_breakaway(fit: Fit, name: str) -> Standing | None:
    """The same in the effort of starts from rest, each weighed as the true model knows it; None where there are few.

    Args:
        fit: of the model without the effect.
        name: of the effect.
    """
    rows, effect = enough_starts(fit), effect_named(name)
    if rows is None or effect.breakaway is None:
        return None
    true = fit_breakaway(rows, [*fit.effects, effect])
    base = replace(fit_breakaway(rows, fit.effects), weight=true.weight)
    blocks, bases, _ = breakaway_blocks(base, candidates(fit.names, fit.dataset.facts))
    return _standing_among(bases, blocks, name)


def _standing_among(bases: Sequence[Base], blocks: Sequence[Block], name: str) -> Standing | None:
    own_blocks = [block for block in blocks if block.name == name]
    known = [(one, bases[block.base], block) for block in own_blocks if (one := _own(bases, block)) is not None]
    if not known:
        return None
    own, base, block = max(known, key=lambda item: _share(item[1], item[2]))
    left = base.residual - own * float(own @ base.residual)
    independent = len(left) / _inflation(left)
    share = _share(base, block)
    noncentrality = -independent * np.log1p(-share)
    correlation, rival = _nearest(bases, blocks, name, own)
    return Standing(
        float(np.sqrt(share / (1.0 - share))),
        float(np.sqrt(max(noncentrality, 0.0) * (1.0 - correlation**2))),
        rival,
        float(np.sqrt(NEEDED / independent)),
    )


def _own(bases: Sequence[Base], block: Block) -> FloatArray | None:
    """What the block explains beyond the base, unit norm."""
    base = bases[block.base]
    directions = _new(base, block)
    own = directions @ (directions.T @ base.residual)
    norm = float(np.linalg.norm(own))
    return own / norm if norm > 0.0 else None


def _share(base: Base, block: Block) -> float:
    """Share of the base's residual power that the block explains."""
    explained = _new(base, block).T @ base.residual
    return min(float(explained @ explained) / float(base.residual @ base.residual), 1.0 - 1e-9)


def _nearest(bases: Sequence[Base], blocks: Sequence[Block], name: str, own: FloatArray) -> tuple[float, str]:
    largest, rival = 0.0, ""
    for block in blocks:
        if block.name != name:
            correlation = float(np.linalg.norm(_new(bases[block.base], block).T @ own))
            if correlation > largest:
                largest, rival = correlation, block.name
    return min(largest, 1.0), rival


def _new(base: Base, block: Block) -> FloatArray:
    """Orthonormal basis of what the block's columns add to the base."""
    columns = block.columns - base.basis @ (base.basis.T @ block.columns)
    fresh = np.linalg.norm(columns, axis=0) > 1e-3 * np.linalg.norm(block.columns, axis=0)
    return orthonormal(columns[:, fresh])


def _inflation(residual: FloatArray) -> float:
    power = float(residual @ residual)
    lag_one = min(max(float(residual[:-1] @ residual[1:]) / power, 0.0), 0.95) if power > 0.0 else 0.0
    return (1.0 + lag_one) / (1.0 - lag_one)
