"""What a fitted model may be missing: blocks to be screened, and what they are judged on top of."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from compensator.lab.effects.effect import MotionRows
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import Screening, screen
from compensator.lab.screening.noise import Noise

WITH_CHAIN = 0  # base with all columns that the measuring chain can produce; others lack what an effect stands in for


class Curves:
    """Free curves, made when they are first asked for: effects with memory are judged without them.

    Args:
        made: the columns of all of them over all rows, shape (N, k) each, by name.
        weighted: picks and weights the tested rows of columns (N, k).
    """

    def __init__(
        self, made: Callable[[], Mapping[str, FloatArray]], weighted: Callable[[FloatArray], FloatArray]
    ) -> None:
        self._made, self._weighted = made, weighted

    def whitened(self, noise: Noise) -> "Curves":
        """The same columns, their blocks whitened."""
        return Curves(lambda: self.columns, lambda columns: noise.whitened(self._weighted(columns)))

    @cached_property
    def columns(self) -> Mapping[str, FloatArray]:
        """By name, over all rows, shape (N, k) each."""
        return self._made()

    @cached_property
    def blocks(self) -> list[Block]:
        """The same as blocks to be screened."""
        if not self.columns:
            return []
        ends = np.cumsum([one.shape[1] for one in self.columns.values()])[:-1]
        whole = np.split(self._weighted(np.column_stack(list(self.columns.values()))), ends, axis=1)
        return [Block(name, own, 0, 1) for name, own in zip(self.columns, whole, strict=True)]


@dataclass(frozen=True)
class Candidates:
    """What a fitted model may be missing, over the rows that are tested.

    Attributes:
        fit: the model, its own prediction in every motion.
        show_in: which rows are tested.
        rows: tested, shape (N,).
        weights: of those rows, shape (n,).
        bases: what blocks are judged on top of; whitened, as all blocks are, where the noise is known.
        named: blocks of catalogue effects, all shapes.
        curves: of every driver, free.
        left_out: effect name -> why it cannot be judged on these trials.
        noise: that a complete model would leave on these rows; None where it was not learnt (see `with_noise`).
        coloured: the bases as they were before they were whitened; None where they are not.
    """

    fit: Fit
    show_in: MotionRows
    rows: BoolArray
    weights: FloatArray
    bases: list[Base]
    named: list[Block]
    curves: Curves
    left_out: dict[str, str]
    noise: Noise | None = None
    coloured: list[Base] | None = None

    @property
    def stretches(self) -> int:
        """How many independent stretches of BLOCK_S the tested rows are of."""
        return self.fit.dataset.stretches(self.rows)

    def with_block(self, block: Block) -> "Candidates":
        """The same candidates judged on top of one more block."""
        return replace(self, bases=[base.extended(block.columns) for base in self.bases])

    def tested(self, columns: FloatArray) -> FloatArray:
        """Columns (N, k) given over all rows as blocks have them: the tested rows, weighted and whitened, (n, k)."""
        weighted = columns[self.rows] * self.weights[:, None]
        return weighted if self.noise is None else self.noise.whitened(weighted)

    def whitened(self, noise: Noise) -> "Candidates":
        """The same candidates on rows whose noise is white: least squares of them are generalised ones."""
        columns = [block.columns for block in self.named]
        for base in self.bases:
            columns += [base.basis, base.residual[:, None]]
        ends = np.cumsum([one.shape[1] for one in columns])[:-1]
        white = np.split(noise.whitened(np.column_stack(columns)), ends, axis=1)  # at once: many trials are short
        named, bases = white[: len(self.named)], white[len(self.named) :]
        return replace(
            self,
            bases=[Base.of(basis, residual[:, 0]) for basis, residual in zip(bases[::2], bases[1::2], strict=True)],
            named=[replace(block, columns=own) for block, own in zip(self.named, named, strict=True)],
            curves=self.curves.whitened(noise),
            noise=noise,
            coloured=self.bases,
        )

    def screened(self, blocks: list[Block]) -> Screening:
        """Evidence for some of them, whitened."""
        assert self.noise is not None
        return screen(self.bases, blocks, self.noise)

    def as_measured(self, index: int) -> Base:
        """One of the bases on weighted rows, every one as it was measured."""
        return (self.coloured or self.bases)[index]
