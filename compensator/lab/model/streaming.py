"""A model's coefficients from any number of rows, with one piece of one recording in memory at a time.

Least squares needs of the rows their normal equations alone: gram, moments, the effort's power, and one small set of
them per trial, so that each trial can be left out in turn. What all trials share (cut-off, scales, shapes of the model,
the load that it predicts) comes from a fit to some of them. Time grows with the rows, memory with the number of trials
times the square of the number of coefficients.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import solve_without
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.low_pass import FILTER_ORDER
from compensator.lab.recordings.processing import EDGE_PERIODS
from compensator.lab.recordings.recording import SESSION_START, BoolArray, Condition, FloatArray, Recording
from compensator.lab.rows.assembly import more_trials

PIECE_ROWS = 200_000
SHORTEST = 6 * FILTER_ORDER  # samples beyond both edges that a filter needs


@dataclass(frozen=True)
class Sums:
    """Normal equations of some rows.

    Attributes:
        gram: shape (k, k); moment: shape (k,), of columns and target.
        power: sum of squared targets; effort_power: of squared efforts.
        rows: how many.
    """

    gram: FloatArray
    moment: FloatArray
    power: float
    effort_power: float
    rows: int

    @classmethod
    def of(cls, columns: FloatArray, target: FloatArray, effort: FloatArray) -> "Sums":
        """Of columns (n, k), what they are fitted to (n,), and effort (n,)."""
        powers = float(target @ target), float(effort @ effort)
        return cls(columns.T @ columns, columns.T @ target, *powers, len(effort))

    def __add__(self, other: "Sums") -> "Sums":
        return Sums(
            self.gram + other.gram,
            self.moment + other.moment,
            self.power + other.power,
            self.effort_power + other.effort_power,
            self.rows + other.rows,
        )

    def residual_power(self, coefficients: FloatArray) -> float:
        """Sum of squared residuals of these rows."""
        explained = coefficients @ (2.0 * self.moment - self.gram @ coefficients)
        return max(self.power - float(explained), 0.0)


@dataclass(frozen=True)
class Streamed:
    """A model fitted to streamed rows.

    Attributes:
        coefficients: of the model's terms in order, shape (k,); 0 where the first fit did not keep them.
        trials: that are in it; rows: that were counted, after thinning; samples: that were read.
        training: relative error; held_out: the same, each trial left out in turn.
        skipped: names of recordings of which nothing, or not all, can be used, and why.
    """

    coefficients: FloatArray
    trials: int
    rows: int
    samples: int
    training: float
    held_out: float
    skipped: dict[str, str] = field(default_factory=dict)


def fit_streamed(fit: Fit, recordings: Iterable[Recording]) -> Streamed:
    """Fit a model anew to recordings that need not fit into memory together.

    Args:
        fit: of the same model to some trials: its cut-off, scales, shapes and predicted load hold for all.
        recordings: read one after the other, each once; pieces of one trial have one name.

    Raises:
        UnusableDataError: no row counts, or fewer than twice the coefficients.
    """
    kept = np.concatenate([term.kept for term in fit.terms])
    bounds = fit.bounds.of(kept)
    trials: dict[str, Sums] = {}
    skipped: dict[str, str] = {}
    samples = 0
    for recording in recordings:
        samples += len(recording)
        for piece in pieces(recording, fit.dataset.cutoff_hz):
            try:
                sums = _sums(fit, piece, kept)
            except UnusableDataError as error:
                skipped[recording.name] = str(error)
                continue
            before = trials.get(recording.name)
            trials[recording.name] = sums if before is None else before + sums
    if not trials:
        raise UnusableDataError("no recording can be used: " + ("; ".join(skipped.values()) or "there is none"))
    whole = _total(list(trials.values()))
    if whole.rows < 2 * len(whole.moment):
        raise UnusableDataError(f"{whole.rows} rows for {len(whole.moment)} coefficients; record longer or more trials")
    equations = whole.gram, whole.moment
    inside = solve_without(equations, (np.zeros_like(whole.gram), np.zeros_like(whole.moment)), bounds)
    without = {name: solve_without(equations, (sums.gram, sums.moment), bounds) for name, sums in trials.items()}
    outside = [sums.residual_power(without[name]) for name, sums in trials.items()]
    coefficients = np.zeros(len(kept))
    coefficients[kept] = inside
    return Streamed(
        coefficients=coefficients,
        trials=len(trials),
        rows=whole.rows,
        samples=samples,
        training=float(np.sqrt(whole.residual_power(inside) / whole.effort_power)),
        held_out=float(np.sqrt(np.sum(outside) / whole.effort_power)),
        skipped=skipped,
    )


def pieces(recording: Recording, cutoff_hz: float) -> Iterator[Recording]:
    """A recording in pieces of PIECE_ROWS, as `piece_starts` has them.

    What a joint remembers of reversals and rests begins anew with each.
    """
    count, time_s = len(recording), recording.channels["time_s"]
    if count <= PIECE_ROWS:
        yield recording
        return
    for start in piece_starts(count, (count - 1) / float(time_s[-1] - time_s[0]), cutoff_hz):
        inside = slice(start, start + PIECE_ROWS)
        channels = {name: values[inside] for name, values in recording.channels.items()}
        later = later_by(recording.conditions, float(time_s[start] - time_s[0]))
        yield replace(recording, channels=channels, conditions=later)


def piece_starts(rows: int, rate_hz: float, cutoff_hz: float) -> range:
    """First rows of pieces of PIECE_ROWS, which overlap by what the filter drops at both ends of each."""
    overlap = 2 * int(np.ceil(EDGE_PERIODS / cutoff_hz * rate_hz))
    return range(0, max(rows - overlap - SHORTEST, 1), max(PIECE_ROWS - overlap, 1))


def later_by(conditions: Mapping[str, Condition], seconds: float) -> dict[str, Condition]:
    """The conditions of a piece that begins so much later in its session."""
    begun_s = conditions.get(SESSION_START, 0.0)
    later = {SESSION_START: begun_s + seconds} if isinstance(begun_s, int | float) else {}
    return {**conditions, **later}


def _sums(fit: Fit, recording: Recording, kept: BoolArray) -> Sums:
    """Normal equations of one piece, on the rows that the model is fitted to."""
    part = more_trials(fit.dataset, [recording])
    dataset = with_own_prediction(part, fit.terms)
    made = dataset.columns_of_effects([(term.effect, [term.shape]) for term in fit.terms])
    columns = np.concatenate([block for (block,) in made], axis=1)[:, kept]
    rows = dataset.in_regimes(dataset.choice_for(fit.effects))
    return Sums.of(columns[rows], dataset.target[rows], dataset.effort[rows])


def _total(parts: list[Sums]) -> Sums:
    whole = parts[0]
    for part in parts[1:]:
        whole = whole + part
    return whole
