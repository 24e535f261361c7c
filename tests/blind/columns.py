"""Candidates as the lab gathers them, made of columns and noise that are known."""

from typing import Any, cast

import numpy as np

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import Candidates, Curves

ROWS = 6000


def gathered(effort: FloatArray, blocks: dict[str, FloatArray]) -> Candidates:
    """Candidates on top of a base of one constant column."""
    rows = np.ones(len(effort), dtype=bool)
    base = Base.of(np.ones((len(effort), 1)), effort)
    named = [Block(name, columns[:, None], 0, 1) for name, columns in blocks.items()]
    fit = cast(Any, _Fit(effort))
    return Candidates(
        fit,
        "sliding",
        rows,
        np.ones(len(effort)),
        [base],
        named,
        Curves(dict, np.asarray),
        {},
    )


class _Fit:
    """As much of a fit as `Candidates.with_block` asks for."""

    def __init__(self, effort: FloatArray) -> None:
        self.dataset = self
        self.effort = effort


def independent(seed: int, count: int) -> FloatArray:
    """So many columns of zero mean and unit power that have nothing to do with each other, shape (count, ROWS)."""
    noise = np.random.default_rng(seed).standard_normal((ROWS, count))
    basis = np.linalg.qr(noise - noise.mean(axis=0))[0]
    return np.asarray(basis.T * np.sqrt(ROWS))
