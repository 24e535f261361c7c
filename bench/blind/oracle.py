"""What a diagnosis could know at best: the fit of the model with the truth in it, and how far the truth stands out.

r = rms of what the base model cannot absorb of the effect / rms of what the true model leaves
lambda = n / v ln(1 + r^2),   v = rows per independent row, from what the true model leaves
d' = sqrt(lambda (1 - rho^2)), rho the largest projected correlation with any other effect of the catalogue
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Base, Block

NEEDED = 25.6  # noncentrality that 64 candidates at 1 % need for 90 % power


@dataclass(frozen=True, slots=True)
class Standing:
    """How far one true effect stands out.

    Attributes:
        ratio: r.
        detectability: d'.
        rival: the effect that is most like it.
        smallest: the r that theory needs to find any one of so many effects nine times in ten.
    """

    ratio: float
    detectability: float
    rival: str
    smallest: float


def standing(gathered: Candidates, name: str) -> Standing | None:
    """How far an effect stands out of a model without it; None where these trials cannot show it at all."""
    blocks = [block for block in gathered.named if block.name == name]
    found = [(one, _share(gathered, block), block) for block in blocks if (one := _own(gathered, block)) is not None]
    if not found:
        return None
    own, share, block = max(found, key=lambda item: item[1])
    base = gathered.bases[block.base]
    left = base.residual - own * float(own @ base.residual)
    independent = len(left) / _inflation(left)
    noncentrality = -independent * np.log1p(-share)
    correlation, rival = _nearest(gathered, name, own)
    return Standing(
        float(np.sqrt(share / (1.0 - share))),
        float(np.sqrt(max(noncentrality, 0.0) * (1.0 - correlation**2))),
        rival,
        float(np.sqrt(NEEDED / independent)),
    )


def _own(gathered: Candidates, block: Block) -> FloatArray | None:
    """What the block explains beyond the base, unit norm."""
    base = gathered.bases[block.base]
    directions = _new(base, block)
    own = directions @ (directions.T @ base.residual)
    norm = float(np.linalg.norm(own))
    return own / norm if norm > 0.0 else None


def _share(gathered: Candidates, block: Block) -> float:
    """Share of the base's residual power that the block explains."""
    base = gathered.bases[block.base]
    explained = _new(base, block).T @ base.residual
    return min(float(explained @ explained) / float(base.residual @ base.residual), 1.0 - 1e-9)


def _nearest(gathered: Candidates, name: str, own: FloatArray) -> tuple[float, str]:
    largest, rival = 0.0, ""
    for block in gathered.named:
        if block.name != name:
            correlation = float(np.linalg.norm(_new(gathered.bases[block.base], block).T @ own))
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
