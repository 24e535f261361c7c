"""Order analysis: how much of what is left comes back with the position, by a periodogram over it.

What turns with the joint, the motor or a wheel between them comes back after so much travel: an order, in cycles per
turn. Cosine and sine of every order are held against what is left, as a force and against the motion, as friction is
(Lomb 1976, Scargle 1982: least squares at uneven places).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from scipy.optimize import minimize_scalar

from compensator.lab.effects.effect import Motion, Round, Shape
from compensator.lab.recordings.low_pass import FILTER_ORDER
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import Dataset

STEPS = 4.0  # per width of a line, as of those in time
MOST_ORDERS = 2000  # a joint of many turns is looked at up to so many
PLACES = 50  # along the travel
SHOWN = 0.1  # of them: what the filter shows at fewer has hardly been seen to come back
AT_ONCE = 2**21  # values of columns
NEW = 0.02  # share of a column's power beside the model: of less, little can be told from the model itself
APART = 1e-3  # of their powers: of less, cosine and sine can hardly be told from each other beside the model

FORCE: Round = "force"
FRICTION: Round = "against the motion"
GROWING = "grows with the speed"


@dataclass(frozen=True)
class Path:
    """Where the rows are, and what makes columns of that.

    Attributes:
        position, speed, direction: of each row, shape (n,).
        weight: of each row, and what the model makes of a column where it bends, shape (n,).
        cutoff_rad_s: of the filter.
    """

    position: FloatArray
    speed: FloatArray
    direction: FloatArray
    weight: FloatArray
    cutoff_rad_s: float

    @classmethod
    def of(cls, dataset: Dataset, rows: BoolArray, weight: FloatArray) -> "Path":
        """Of chosen rows (n of N) and their weights (n,)."""

        def each(value: Callable[[Motion], FloatArray]) -> FloatArray:
            return dataset.rows_of([value(trial.motion) for trial in dataset.trials])[rows]

        return cls(
            each(lambda motion: motion.position),
            np.abs(each(lambda motion: motion.velocity)),
            each(lambda motion: motion.direction),
            weight * dataset.stack(1.0 + trial.motion.bend[None] for trial in dataset.trials)[rows, 0],
            2.0 * np.pi * dataset.cutoff_hz,
        )

    @property
    def once(self) -> float:
        """The width of a line: once over the travel [rad per unit of position]."""
        return float(2.0 * np.pi / max(float(np.ptp(self.position)), np.finfo(float).tiny))

    @cached_property
    def highest(self) -> float:
        """The highest order that enough of the travel was passed slowly enough for [rad per unit of position].

        Where the joint turns back it is slow, too: over so short a way that any curve is a part of some wave.
        """
        travel = max(float(np.ptp(self.position)), np.finfo(float).tiny)
        place = np.minimum((PLACES * (self.position - self.position.min()) / travel).astype(np.int64), PLACES - 1)
        slowest = np.full(PLACES, np.inf)
        np.minimum.at(slowest, place, self.speed)
        return self.cutoff_rad_s / max(float(np.sort(slowest)[int(SHOWN * PLACES) - 1]), np.finfo(float).tiny)

    def shown(self, grid: Sequence[Shape]) -> list[Shape]:
        """Shapes whose order the rows show, of a grid of an effect that goes round; the lowest where they show none."""
        return [shape for shape in grid if shape[0] <= self.highest] or [min(grid)]

    @property
    def orders(self) -> FloatArray:
        """From once over the travel to the highest that can show [rad per unit of position]."""
        count = int(np.clip((self.highest / self.once - 1.0) * STEPS, 1.0, MOST_ORDERS))
        orders: FloatArray = self.once * (1.0 + np.arange(count) / STEPS)
        return orders

    def columns(self, orders: FloatArray) -> FloatArray:
        """Cosines, then sines, of even orders (m,) [rad per unit of position], filtered and weighted, shape (n, 2m)."""
        step = float(orders[1] - orders[0]) if len(orders) > 1 else 0.0
        return even_waves(
            self.position, self.speed / self.cutoff_rad_s, self.weight, float(orders[0]), step, len(orders)
        )

    def factor(self, kind: str) -> FloatArray:
        """Of such columns of one kind, shape (n, 1); of a force, (1, 1)."""
        factors = {FORCE: np.ones(1), FRICTION: self.direction, GROWING: self.speed**2}
        return factors[kind][:, None]

    def scanned(
        self, basis: FloatArray, residual: FloatArray, orders: FloatArray, kinds: Sequence[str]
    ) -> dict[str, FloatArray]:
        """What even orders (m,) explain of a residual (n,) beside a basis (n, b), of each kind: shape (m,)."""
        sizes: dict[str, list[FloatArray]] = {kind: [] for kind in kinds}
        for some in np.array_split(orders, -(-2 * len(orders) * len(self.position) // AT_ONCE)):
            columns = self.columns(some)
            for kind, found in sizes.items():
                found.append(explained(columns if kind == FORCE else self.factor(kind) * columns, basis, residual))
        return {kind: np.concatenate(found) for kind, found in sizes.items()}

    def refined(self, basis: FloatArray, residual: FloatArray, order: float, kind: str) -> float:
        """The order that explains most within one step of those that were scanned."""

        def left(other: float) -> float:
            return -float(self.scanned(basis, residual, np.array([other]), (kind,))[kind][0])

        step = self.once / STEPS
        found = minimize_scalar(
            left, bounds=(order - step, order + step), method="bounded", options={"xatol": 0.01 * step}
        )
        return float(found.x)


@njit(cache=True)
def even_waves(
    position: FloatArray, passing: FloatArray, weight: FloatArray, first: float, step: float, count: int
) -> FloatArray:
    """`Path.columns` of so many orders, from the first on by even steps [rad per unit of position].

    A turn by each step takes less time than a cosine of its own; `passing` is the speed over the filter's cut-off, 0 of
    what is not filtered.
    """
    columns = np.empty((len(position), 2 * count))
    for row in range(len(position)):
        cosine, sine = np.cos(first * position[row]), np.sin(first * position[row])
        onward, aside = np.cos(step * position[row]), np.sin(step * position[row])
        for index in range(count):
            ratio = passing[row] * (first + step * index)
            passed = weight[row] / (1.0 + ratio ** (2 * FILTER_ORDER))  # there and back
            columns[row, index], columns[row, count + index] = passed * cosine, passed * sine
            cosine, sine = onward * cosine - aside * sine, aside * cosine + onward * sine
    return columns


def explained(columns: FloatArray, basis: FloatArray, residual: FloatArray) -> FloatArray:
    """What each pair of white cosines, then sines (n, 2m), explains of a residual (n,) beside a basis (n, b).

    Shape (m,), chi-squared of two in noise alone; 0 where the two are not apart, from each other or from the basis.
    """
    half = columns.shape[1] // 2
    taken = basis.T @ columns
    whole = np.einsum("nk,nk->k", columns, columns)
    left = whole - np.einsum("bk,bk->k", taken, taken)
    both = np.einsum("nk,nk->k", columns[:, :half], columns[:, half:])
    both -= np.einsum("bk,bk->k", taken[:, :half], taken[:, half:])
    (cosine, sine), (a, b) = np.split(residual @ columns, 2), np.split(left, 2)
    area = a * b - both**2
    new = np.all(np.split(left > NEW * whole, 2), axis=0)
    apart = new & (area > APART * a * b)
    size = (b * cosine**2 - 2.0 * both * cosine * sine + a * sine**2) / np.where(apart, area, 1.0)
    return np.where(apart, size, 0.0)
