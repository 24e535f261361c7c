"""Nonlinear shape values by variable projection.

Linear coefficients are eliminated for every shape tried (Golub, Pereyra 1973), so that only the few shape values are
searched: over the effect's grid first, then, where the shape is continuous, between its values.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.optimize import minimize

from compensator.lab.effects.effect import Effect, Shape
from compensator.lab.model.fitted import bounds_of
from compensator.lab.model.linear import orthonormal
from compensator.lab.model.order_search import Path
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import Dataset

SWEEPS = 2  # the first shape is found while the others' are guesses
REFINEMENTS = 24  # evaluations between the grid's values, at least
REFINED_EACH = 12  # and for each value of a shape
TINY = 1e-12
STEP = 0.2  # of the logarithm, at first


def first_shapes(dataset: Dataset, effects: Sequence[Effect]) -> dict[str, Shape]:
    """The middle of every effect's grid."""
    motions = [trial.motion for trial in dataset.trials]
    grids = {effect.name: effect.grid(motions) for effect in effects if effect.shape_names}
    return {name: grid[len(grid) // 2] for name, grid in grids.items()}


def find_shapes(
    dataset: Dataset,
    effects: Sequence[Effect],
    rows: BoolArray,
    kept: Mapping[str, Shape],
    weight: FloatArray,
    start: Mapping[str, Shape] | None = None,
    known: bool = False,
) -> dict[str, Shape]:
    """The shape of every effect that has one, each searched with the others held; twice, where there are others.

    Args:
        dataset: of the rows.
        effects: of the model, in order.
        rows: to fit to, shape (N,).
        kept: shapes that are not searched but taken as they are.
        weight: of each row, shape (N,).
        start: shapes that the others have until they are searched; else the middle of their grids.
        known: these were found beside nearly the same prediction; what is smooth is looked for around them alone.
    """
    shapes = {**first_shapes(dataset, effects), **(start or {}), **kept}
    searched = [effect for effect in effects if effect.shape_names and effect.name not in kept]
    for _ in range(min(len(searched), SWEEPS)):
        for effect in searched:
            others = [dataset.columns(other, shapes.get(other.name, ())) for other in effects if other is not effect]
            fixed = np.concatenate(others, axis=1)[rows] if others else np.empty((int(rows.sum()), 0))
            search = _Search(dataset, effect, rows, fixed, weight[rows])
            near = shapes[effect.name] if known and effect.smooth_shape else None
            best = near or (search.grow() if effect.grows else search.scan())
            shapes[effect.name] = search.refine(best) if effect.smooth_shape else best
    return shapes


class _Search:
    """Explained power of one effect's shapes, on top of fixed columns."""

    def __init__(
        self, dataset: Dataset, effect: Effect, rows: BoolArray, fixed: FloatArray, weight: FloatArray
    ) -> None:
        self._dataset, self._effect, self._rows, self._weight = dataset, effect, rows, weight[:, None]
        self._basis = orthonormal(self._weight * fixed)
        effort = weight * dataset.target[rows]
        self._rest = effort - self._basis @ (self._basis.T @ effort)
        whole = effect.grid([trial.motion for trial in dataset.trials])
        self._grid = [shape for shape in whole if effect.searched(shape)]
        self._beyond = [shape for shape in whole if not effect.searched(shape)]
        self._bounds = bounds_of([effect], dataset)

    def explained(self, columns: FloatArray) -> float:
        """Power that columns (N, k) explain of what the fixed ones leave; of one alone, within its bounds."""
        inside = self._weight * columns[self._rows]
        inside = inside - self._basis @ (self._basis.T @ inside)
        if inside.shape[1] == 1:
            return power_within(inside[:, 0], self._rest, (float(self._bounds.low[0]), float(self._bounds.high[0])))
        basis = orthonormal(inside)
        shares = basis.T @ self._rest
        return float(shares @ shares)

    def scan(self) -> Shape:
        """The best shape of the effect's grid, or an order between or beyond, of a wheel that nobody tells of."""
        path = None if self._effect.goes_round is None else Path.of(self._dataset, self._rows, self._weight[:, 0])
        self._grid = self._grid if path is None else path.shown(self._grid)
        powers = [self.explained(columns) for columns in self._columns()]
        best = int(np.argmax(powers))
        other = None if path is None else self._off_grid(path)
        if other is not None and self.explained(self._dataset.columns(self._effect, other)) > powers[best]:
            return other
        return self._grid[best]

    def _off_grid(self, path: Path) -> Shape | None:
        """The order off the grid that explains most; None where all that the rows show lie within a line's width of it.

        What goes round with a shaft does so a whole number of times: so near to one of the grid it is that.
        """
        kind, grid, orders = self._effect.goes_round, np.array(self._grid)[:, 0], path.orders
        apart = (np.abs(orders[:, None] - grid).min(axis=1) > path.once) & (orders > grid.min())
        if kind is None or not apart.any():
            return None
        sizes = path.scanned(self._basis, self._rest, orders, (kind,))[kind]
        best = float(orders[np.argmax(np.where(apart, sizes, 0.0))])
        return (path.refined(self._basis, self._rest, best, kind),)

    def grow(self) -> Shape:
        """One order after the other, each the best beside those before it, while the rows pay for it (BIC)."""
        orders = [shape[0] for shape in self._grid]
        weighted = [self._weight * one[self._rows][:, :2] for one in self._columns()]
        basis, rest = self._basis, self._rest
        grown: list[float] = []
        while len(grown) < len(self._grid[0]):
            blocks = [orthonormal(one - basis @ (basis.T @ one)) for one in weighted]
            powers = [float(np.sum((block.T @ rest) ** 2)) for block in blocks]
            best = int(np.argmax(powers))
            left, count = float(rest @ rest), independent_rows(rest - blocks[best] @ (blocks[best].T @ rest))
            price = 2.0 * np.log(count) + 2.0 * np.log(len(orders))
            if grown and count * np.log(left / max(left - powers[best], TINY * left)) < price:
                break
            grown.append(orders[best])
            basis = np.column_stack([basis, blocks[best]])
            rest = rest - blocks[best] @ (blocks[best].T @ rest)
        return tuple(grown + [0.0] * (len(self._grid[0]) - len(grown)))

    def _columns(self) -> list[FloatArray]:
        return self._dataset.columns_of_shapes(self._effect, self._grid)

    def refine(self, start: Shape) -> Shape:
        """The best shape between the grid's values, from a start."""

        def loss(shape: Shape) -> float:
            if not self._effect.searched(shape):
                return np.inf
            motions = [self._effect.columns(trial.motion, shape) for trial in self._dataset.trials]
            return -self.explained(self._dataset.stack(motions))

        return between([*self._grid, *self._beyond], start, loss)


def independent_rows(rest: FloatArray) -> float:
    """How many rows what is left (n,) is worth: neighbours are alike, as those of an autoregression of first order."""
    centred = rest - rest.mean()
    power = float(centred @ centred)
    alike = float(centred[1:] @ centred[:-1]) / power if power > 0.0 else 0.0
    alike = min(max(alike, 0.0), 0.99)
    return max(len(rest) * (1.0 - alike) / (1.0 + alike), 2.0)


def power_within(column: FloatArray, rest: FloatArray, bounds: tuple[float, float]) -> float:
    """Power that a column (n,) explains of what is left (n,), its coefficient within its bounds."""
    size, share = float(column @ column), float(column @ rest)
    coefficient = float(np.clip(share / size, *bounds)) if size > 0.0 else 0.0
    return coefficient * (2.0 * share - coefficient * size)


def between(grid: Sequence[Shape], start: Shape, loss: Callable[[Shape], float]) -> Shape:
    """The shape of least loss between a grid's values, from one of them, on a logarithmic scale.

    A value that the whole grid shares stays as it is. The simplex method (Nelder, Mead 1965), in so many evaluations
    that the shape is known to a percent or so.
    """
    low, high = np.log(np.min(grid, axis=0)), np.log(np.max(grid, axis=0))
    free = low < high
    if not free.any():
        return start

    def shape_of(logs: FloatArray) -> Shape:
        whole = np.log(np.array(start))
        whole[free] = logs
        return tuple(float(x) for x in np.exp(np.clip(whole, low, high)))

    centre, axes = np.log(np.array(start))[free], np.eye(int(free.sum()))
    simplex = np.clip(centre + np.vstack([np.zeros(len(centre)), STEP * axes]), low[free], high[free])
    simplex[1:] += np.where(np.abs(simplex[1:] - centre).max(axis=1) < 1e-6, -STEP, 0.0)[:, None] * axes
    evaluations = max(REFINEMENTS, len(centre) * REFINED_EACH)
    options = {"maxfev": evaluations, "xatol": 0.01, "fatol": 0.0, "initial_simplex": simplex}
    return shape_of(minimize(lambda logs: loss(shape_of(logs)), centre, method="Nelder-Mead", options=options).x)
