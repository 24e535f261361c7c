"""Where a model is wrong: its error over speed and load."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.drivers import available
from compensator.lab.rows.picture import FEWEST_PER_BIN

SPEEDS, LOADS = 12, 5
MOST_LOADS = 10  # distinct known loads that get a row each
TAIL = 0.005  # share of rows beyond the outer edges at each end; they count in the outer cells


@dataclass(frozen=True)
class ErrorMap:
    """Error in cells of two driving variables.

    Attributes:
        across, down: names of the variables; keys of `compensator.lab.rows.drivers.DRIVERS`.
        across_edges: shape (a + 1,), rising; down_edges: shape (d + 1,), rising.
        rms: of the residual in each cell, in the effort's unit, shape (d, a); NaN where too few rows are.
        mean: of the residual, shape (d, a).
        count: rows, shape (d, a).
    """

    across: str
    down: str
    across_edges: FloatArray
    down_edges: FloatArray
    rms: FloatArray
    mean: FloatArray
    count: FloatArray


def error_map(fit: Fit) -> ErrorMap:
    """Error over velocity and load: the known load where it differs between trials, else the predicted one.

    Raises:
        NotApplicableError: neither velocity nor load differs over the rows.
    """
    values = available(fit.dataset)
    down = next((name for name in ("load_kg", "load", "position") if name in values), None)
    if "velocity" not in values or down is None:
        raise NotApplicableError("speed or load is the same in all rows; record several speeds under several loads")
    rows = fit.dataset.counted
    across_edges = _even(values["velocity"][rows])
    down_edges = _known(values[down]) if down == "load_kg" else _quantiles(values[down][rows])
    shape = len(down_edges) - 1, len(across_edges) - 1
    cell = (_bin(values[down], down_edges) * shape[1] + _bin(values["velocity"], across_edges))[rows]
    residual = fit.residual[rows]
    size = shape[0] * shape[1]
    count = np.bincount(cell, minlength=size).astype(float)
    enough = np.where(count >= FEWEST_PER_BIN, count, np.nan)
    mean = np.bincount(cell, residual, minlength=size) / enough
    square = np.bincount(cell, residual**2, minlength=size) / enough
    return ErrorMap(
        "velocity", down, across_edges, down_edges, *(one.reshape(shape) for one in (np.sqrt(square), mean, count))
    )


def _even(values: FloatArray) -> FloatArray:
    low, high = np.quantile(values, [TAIL, 1.0 - TAIL])
    edges: FloatArray = np.linspace(low, high, SPEEDS + 1)
    return edges


def _quantiles(values: FloatArray) -> FloatArray:
    edges: FloatArray = np.unique(np.quantile(values, np.linspace(0.0, 1.0, LOADS + 1)))
    return edges


def _known(values: FloatArray) -> FloatArray:
    """Edges half-way between the loads that were hung."""
    loads = np.unique(values)
    if len(loads) > MOST_LOADS:
        return _quantiles(values)
    between = (loads[1:] + loads[:-1]) / 2.0
    return np.concatenate([[loads[0] - (between[0] - loads[0])], between, [loads[-1] + (loads[-1] - between[-1])]])


def _bin(values: FloatArray, edges: FloatArray) -> FloatArray:
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
