"""The error of a model on rows that it was not fitted to, and that of two models on even terms."""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray

HeldOutKind = Literal["hold-out", "leave-one-trial-out", "leave-one-block-out"]

LEAST_OF_EFFORT = 5e-4  # of the effort, root mean square: no sensor is more linear


@dataclass(frozen=True)
class HeldOut:
    """Residuals on rows that the coefficients have not seen.

    Attributes:
        kind: how rows were held out.
        rows: which rows, shape (N,).
        residual: of those rows, shape (rows.sum(),).
        effort: measured, of those rows.
        unit: which independent unit (trial or block) each of these rows belongs to.
        relative: root of residual power over effort power.
        rms: root mean square residual, in the effort's unit.
        weight: of each row, by how little it scatters and how well its prediction is known (see `weights_of`); unless a
            study names what is held out, less where the other rows tell little of the coefficients.
    """

    kind: HeldOutKind
    rows: BoolArray
    residual: FloatArray
    effort: FloatArray
    unit: IntArray
    relative: float
    rms: float
    weight: FloatArray = field(default_factory=lambda: np.ones(1))

    def power_by_unit(self) -> FloatArray:
        """Sum of squared residuals of each independent unit, in order of its label."""
        return self._by_unit(self.residual)

    def effort_power_by_unit(self) -> FloatArray:
        """Sum of squared efforts of each independent unit, in order of its label."""
        return self._by_unit(self.effort)

    def _by_unit(self, values: FloatArray) -> FloatArray:
        _, dense = np.unique(self.unit, return_inverse=True)
        return np.bincount(dense, weights=values**2).astype(float)


def relative_error(residual: FloatArray, effort: FloatArray) -> float:
    """||residual|| / ||effort||."""
    power = float(effort @ effort)
    return float(np.sqrt((residual @ residual) / power)) if power > 0 else float("nan")


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def on_even_terms(one: HeldOut, other: HeldOut) -> tuple[HeldOut, HeldOut]:
    """Two models' errors on the same rows, each row counting by how well either model could predict it.

    Where a trial is the only one to tell of a coefficient, as the only one without load does of the arm alone, what the
    others make of it is a guess by any model, and would outweigh all that they do know; so would, beside a dead time,
    rows without current, and a few rows where teeth fly. Weights are those of errors of known variance (Aitken 1935),
    the larger of the two models'. Rows that are alike are left as they are.
    """
    weight = np.broadcast_to(np.minimum(one.weight, other.weight), one.residual.shape)
    first, second = (_weighted(error, weight) for error in (one, other))
    return first, second


def _weighted(error: HeldOut, weight: FloatArray) -> HeldOut:
    """The same, each of its rows multiplied by a weight, and all alike then."""
    residual, effort = weight * error.residual, weight * error.effort
    relative = relative_error(residual, effort)
    return replace(error, residual=residual, effort=effort, relative=relative, rms=rms(residual), weight=np.ones(1))
