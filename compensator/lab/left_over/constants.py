"""What a model takes for constant, dry friction and the zero, on the rows where that is judged."""

from dataclasses import dataclass

from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Base

DRY_FRICTION, OFFSET = "dry friction", "a constant force or the zero of the angle"


@dataclass(frozen=True)
class Constants:
    """Chosen rows (n of N) of a model, and what it takes for constant there.

    Attributes:
        dataset: of the rows.
        rows: chosen, shape (N,).
        base: what the model explains of them, and the weighted residual (n,).
        weights: of the chosen rows, shape (n,).
        friction: dry friction, in the effort's unit.
        static: how much of the effort is static friction that has not fallen off yet, shape (n,).
    """

    dataset: Dataset
    rows: BoolArray
    base: Base
    weights: FloatArray
    friction: float
    static: FloatArray

    @property
    def sliding(self) -> BoolArray:
        """Near reversals nothing is constant; shape (n,)."""
        found: BoolArray = self.dataset.regime[self.rows] == Regime.SLIDING
        return found

    @property
    def direction(self) -> FloatArray:
        """That dry friction has, shape (n,)."""
        return self.of([trial.motion.direction for trial in self.dataset.trials])

    @property
    def effort(self) -> FloatArray:
        """As measured, shape (n,)."""
        return self.dataset.effort[self.rows]

    def of(self, signals: list[FloatArray]) -> FloatArray:
        """A signal of each trial, at the chosen rows, shape (n,)."""
        return self.dataset.rows_of(signals)[self.rows]
