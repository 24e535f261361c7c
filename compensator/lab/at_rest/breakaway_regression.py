"""The small regression beside that of the rows in motion: the effort of breaking away, by the same effects.

Static friction is a number of its own here, and so is every effect's share: what holds a joint and what brakes it are
not the same. What the effort gains until a motion is fast enough to be seen is a column of its own: a body that lets go
under an effort that grows at a rate r takes a time (2 J v / r)^(1/2) to the speed v, and the effort grows by
(2 J v r)^(1/2) meanwhile. A heavier arm is seen later, which is no friction of its weight.

Where the joint turns back, its contacts are still bent the way that it came, and come to their whole friction one after
the other (generalized Maxwell slip: Lampaert, Al-Bender, Swevers 2003): such starts are seen at less. What turns back
rests for a short time, as a rule, and dwell would be taken for it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.at_rest.breakaway_rows import BreakawayRows, shares_of
from compensator.lab.effects.effect import Effect, Parameter, Shape
from compensator.lab.model.held_out_error import HeldOut, HeldOutKind, relative_error, rms
from compensator.lab.model.linear import Bounds, solve
from compensator.lab.model.prediction import whole_inertia
from compensator.lab.model.validation import FEWEST_TRIALS
from compensator.lab.recordings.recording import BoolArray, FloatArray

LAG = "onset_lag"  # what stands for seeing the motion late
BACK = "turned_back"  # what starts back the way the joint came have less
NORMAL = 1.4826  # standard deviation over median absolute deviation
OUTLYING, ALIEN = 2.5, 6.0  # standard deviations, from which a start counts less (Huber 1964), and not at all
ROUNDS = 5  # of learning how much starts scatter beyond what their effort does


@dataclass(frozen=True)
class Share:
    """One fitted share of the breakaway effort: of an effect, of turning back, or of the late onset."""

    name: str
    shape: Shape
    parameters: tuple[Parameter, ...]
    coefficients: FloatArray
    kept: BoolArray


@dataclass(frozen=True)
class BreakawayFit:
    """A model fitted to the training rows of breakaway. E rows in all.

    Attributes:
        rows: all of them.
        shares: in the model's order, the lag last.
        columns: of all shares, shape (E, K).
        bounds: of the coefficients.
        weight: of each row, shape (E,).
        scatter: standard deviation of one breakaway about the model, in the effort's unit.
    """

    rows: BreakawayRows
    shares: tuple[Share, ...]
    columns: FloatArray
    bounds: Bounds
    weight: FloatArray
    scatter: float

    @property
    def predicted(self) -> FloatArray:
        """Predicted effort of every row, shape (E,)."""
        coefficients = np.concatenate([share.coefficients for share in self.shares])
        predicted: FloatArray = self.rows.held + self.columns @ coefficients
        return predicted

    @property
    def residual(self) -> FloatArray:
        """Measured minus predicted effort of every row, shape (E,)."""
        return self.rows.effort - self.predicted

    def coefficients_of(self, name: str) -> FloatArray | None:
        """Of one share; None where it has none."""
        return next((share.coefficients for share in self.shares if share.name == name), None)


def fit_breakaway(
    rows: BreakawayRows, effects: Sequence[Effect], shapes: Mapping[str, Shape] | None = None
) -> BreakawayFit:
    """Fit effects to the training rows, every coefficient within its bounds.

    Args:
        rows: of breakaway.
        effects: those with a share are used.
        shapes: of the shares that are not to be searched.
    """
    known = dict(shapes or {})
    for effect, share in shares_of(effects):
        options = rows.shapes(share)
        if effect.name not in known:
            tried = [{**known, effect.name: option} for option in options]
            known = tried[0] if len(tried) == 1 else min(tried, key=lambda one: _power(_fit(rows, effects, one)))
    return _fit(rows, effects, known)


def _power(fit: BreakawayFit) -> float:
    inside = fit.rows.training
    return float(np.sum((fit.weight[inside] * fit.residual[inside]) ** 2))


def _fit(rows: BreakawayRows, effects: Sequence[Effect], shapes: Mapping[str, Shape]) -> BreakawayFit:
    named = [
        (effect.name, shapes.get(effect.name, rows.shapes(share)[0]), share.parameters, share)
        for effect, share in shares_of(effects)
    ]
    blocks = [rows.columns(share, shape) for _, shape, _, share in named]
    parts: list[tuple[str, Shape, tuple[Parameter, ...]]] = [one[:3] for one in named]
    parts.append((BACK, (), (Parameter("more where the joint turns back", "{effort}", -np.inf, 0.0),)))
    parts.append((LAG, (), (Parameter("gained until motion is seen, over that until the slow speed", "1", 0.0),)))
    blocks += [back_column(rows), lag_column(rows)]
    columns = np.nan_to_num(np.concatenate(blocks, axis=1))
    parameters = [parameter for _, _, own in parts for parameter in own]
    bounds = Bounds(np.array([p.low for p in parameters]), np.array([p.high for p in parameters]))
    weight, scatter = weights_of(rows, columns)
    inside = rows.training
    solution = solve(weight[inside, None] * columns[inside], weight[inside] * rows.free[inside], bounds)
    ends = np.cumsum([0, *(len(own) for _, _, own in parts)])
    shares = tuple(
        Share(*part, solution.coefficients[a:b], solution.kept[a:b])
        for part, a, b in zip(parts, ends[:-1], ends[1:], strict=True)
    )
    return BreakawayFit(rows, shares, columns, bounds, weight, scatter)


def back_column(rows: BreakawayRows) -> FloatArray:
    """The direction of starts where the joint turns back, 0 of others, shape (E, 1)."""
    return (rows.direction * rows.turns_back)[:, None]


def lag_column(rows: BreakawayRows) -> FloatArray:
    """What the effort gains along the motion until the speed is the slow one, shape (E, 1)."""
    dataset = rows.fit.dataset
    inertia = whole_inertia(rows.fit.terms, dataset.tip_kg_m2)[rows.trial_index]
    gained = np.sqrt(2.0 * np.maximum(inertia, 0.0) * dataset.scales.slow * rows.rate)
    # without an inertia in the model, it is the same in all trials, and the coefficient has its unit
    return (rows.direction * (gained if np.all(inertia > 0.0) else np.sqrt(rows.rate)))[:, None]


def weights_of(rows: BreakawayRows, columns: FloatArray) -> tuple[FloatArray, float]:
    """Weights (E,), median 1, and the scatter of starts beyond what their effort's own makes.

    How well an effort is known: by its scatter before the start, and by what it gains from sample to sample.
    """
    known = rows.effort_sd**2 + (rows.rate * _period_s(rows)) ** 2 / 12.0  # uniform within a sample
    extra, inside = 0.0, rows.training
    weight = np.ones(len(rows))
    for _ in range(ROUNDS):
        found = np.linalg.lstsq(weight[inside, None] * columns[inside], weight[inside] * rows.free[inside], rcond=1e-9)
        rest = np.abs(rows.free - columns @ found[0])
        scatter = NORMAL * float(np.median(rest[inside]))
        extra = max(scatter**2 - float(np.median(known[inside])), (0.3 * scatter) ** 2)
        deviation = np.sqrt(known + extra)
        tiny = np.finfo(float).tiny
        outlying = np.minimum(1.0, OUTLYING * deviation / np.maximum(rest, tiny)) * (rest < ALIEN * deviation)
        weight = outlying * np.median(deviation) / np.maximum(deviation, tiny)
    return weight, float(np.sqrt(extra))


def _period_s(rows: BreakawayRows) -> FloatArray:
    trials = rows.fit.dataset.trials
    return np.array([1.0 / trials[index].signals.rate_hz for index in rows.trial_index])


def held_out_breakaway(fit: BreakawayFit, weight: FloatArray | None = None) -> HeldOut:
    """The error on breakaways that the model was not fitted to: of held-out trials, else by leaving out each in turn.

    Args:
        fit: to be judged.
        weight: of each row in the error, shape (E,), so that a start unlike the others does not decide; of the fit, if
            None. Two models are compared under the same weights.
    """
    rows = fit.rows
    counts = fit.weight if weight is None else weight
    outside = ~rows.training
    if outside.any():
        residual, effort = (counts * fit.residual)[outside], (counts * rows.effort)[outside]
        unit = rows.trial_index[outside]
        return HeldOut("hold-out", outside, residual, effort, unit, relative_error(residual, effort), rms(residual))
    many = len(np.unique(rows.trial_index)) >= FEWEST_TRIALS
    units = rows.trial_index if many else rows.unit
    residual = np.zeros(len(rows))
    for label in np.unique(units):
        own = units == label
        weighted = fit.weight[~own, None] * fit.columns[~own]
        solution = solve(weighted, fit.weight[~own] * rows.free[~own], fit.bounds)
        residual[own] = counts[own] * (rows.free[own] - fit.columns[own] @ solution.coefficients)
    effort = counts * rows.effort
    kind: HeldOutKind = "leave-one-trial-out" if many else "leave-one-block-out"
    return HeldOut(kind, rows.training, residual, effort, units, relative_error(residual, effort), rms(residual))
