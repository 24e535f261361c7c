"""What a fitted model may be missing: blocks to be screened, and what they are judged on top of."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from compensator.lab.effects.effect import MotionRows
from compensator.lab.model.fitted import STATIC, Fit
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.stops import StopToStop

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

    def evened(self, noise: Noise) -> "Curves":
        """The same columns, their blocks evened."""
        return Curves(lambda: self.columns, lambda columns: noise.evened(self._weighted(columns)))

    @cached_property
    def columns(self) -> Mapping[str, FloatArray]:
        """By name, over all rows, shape (N, k) each."""
        return self._made()

    @cached_property
    def blocks(self) -> list[Block]:
        """The same as blocks to be screened."""
        return [Block(name, self._weighted(columns), 0, 1) for name, columns in self.columns.items()]


@dataclass(frozen=True)
class Candidates:
    """What a fitted model may be missing, over the rows that are tested.

    Attributes:
        fit: the model, its own prediction in every motion.
        show_in: which rows are tested.
        rows: tested, shape (N,).
        weights: of those rows, shape (n,).
        bases: what blocks are judged on top of; evened, as all blocks are, where the noise is known.
        named: blocks of catalogue effects, all shapes.
        curves: of every driver, free.
        left_out: effect name -> why it cannot be judged on these trials.
        noise: that a complete model would leave on these rows; None where it was not learnt (see `with_noise`).
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

    @property
    def stretches(self) -> int:
        """How many independent stretches of BLOCK_S the tested rows are of."""
        return len(np.unique(self.fit.dataset.block_index[self.rows]))

    def with_block(self, block: Block) -> "Candidates":
        """The same candidates judged on top of one more block."""
        return replace(self, bases=[base.extended(block.columns) for base in self.bases])

    def tested(self, columns: FloatArray) -> FloatArray:
        """Columns (N, k) given over all rows as blocks have them: the tested rows, weighted and evened, (n, k)."""
        weighted = columns[self.rows] * self.weights[:, None]
        return weighted if self.noise is None else self.noise.evened(weighted)

    def evened(self, noise: Noise) -> "Candidates":
        """The same candidates, judged against a noise: rows count by what it leaves sure."""
        return replace(
            self,
            bases=[
                Base.of(noise.evened(base.basis), noise.evened(base.residual[:, None])[:, 0]) for base in self.bases
            ],
            named=[replace(block, columns=noise.evened(block.columns)) for block in self.named],
            curves=self.curves.evened(noise),
            noise=noise,
        )

    def as_measured(self, index: int) -> Base:
        """One of the bases on weighted rows, every one as it was measured."""
        base = self.bases[index]
        if self.noise is None:
            return base
        return Base.of(self.noise.as_measured(base.basis), self.noise.as_measured(base.residual[:, None])[:, 0])


def noise_of(gathered: Candidates, left: Candidates, stops: bool = True) -> Noise:
    """The noise of the candidates' rows, from what is left of them once more is in the model.

    Args:
        gathered: the candidates.
        left: the same, beside what is taken off.
        stops: what lasts from stop to stop is told apart, which takes as long again.
    """
    before = float(gathered.bases[0].residual @ gathered.bases[0].residual)
    base = left.bases[0]
    strokes = _strokes_of(gathered) if stops else None
    return Noise.learnt(gathered.fit.dataset, gathered.rows, (base.basis, base.residual), before, strokes)


def _strokes_of(gathered: Candidates) -> StopToStop | None:
    """Static friction from stop to stop in the tested rows; None where the model has none."""
    fit, rows = gathered.fit, gathered.rows
    ends = np.cumsum([len(term.coefficients) for term in fit.terms])
    place = next((int(end) - 1 for end, term in zip(ends, fit.terms, strict=True) if term.effect.name == STATIC), None)
    if place is None or fit.coefficients[place] <= 0.0:
        return None
    stroke = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in fit.dataset.trials])
    _, index = np.unique(np.stack([fit.dataset.trial_index, stroke])[:, rows], axis=1, return_inverse=True)
    share = gathered.weights * fit.columns[rows, place] * fit.coefficients[place]
    return StopToStop(share, np.asarray(index, dtype=np.int64).ravel())
