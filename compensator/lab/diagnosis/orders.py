"""Whether what a model leaves comes back with the position: order analysis, whatever the order, and the catalogue.

What turns with the joint, the motor or a wheel between them comes back after so much travel: an order, in cycles per
turn. A periodogram over the position, on rows whitened by the noise that a complete model would leave, holds cosine and
sine of every order against that noise, once as a force and once against the motion, as friction is (Lomb 1976, Scargle
1982: least squares at uneven places). Chance has as many tries as there are independent orders, twice.

A line in one stretch may be of time as well as of position, so that the others must foretell what each stretch holds.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.model.linear import orthonormal
from compensator.lab.model.validation import rms
from compensator.lab.recordings.low_pass import FILTER_ORDER
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import IntArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import Base
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.whitening import Whitening

CHANCE = 1e-3  # of such a line at any order, in noise alone
STEPS = 3.0  # per width of a line, so that none falls between two orders
MOST_ORDERS = 1500  # a joint of many turns is looked at up to so many
SLOW = 0.1  # share of the rows, the slowest: an order that even these pass too quickly for the filter cannot show
AT_ONCE = 2**21  # values of columns
FORETOLD = 20.0  # evidence, as 2 ln L, of what all other stretches foretell of each, the best one left out
NEW = 0.02  # share of a column's power beside the model: of less, little can be told from the model itself
APART = 1e-3  # of cosine and sine, likewise
TINY = float(np.finfo(float).tiny)
LEAST_OF_EFFORT = 0.0005  # root mean square: no sensor is more linear


@dataclass(frozen=True, slots=True)
class Line:
    """What comes back with the position.

    Attributes:
        order: cycles per turn; of a linear joint, cycles per unit of position.
        against_motion: it changes its sign with the direction of motion, as friction does.
        chance: of such a line at any order, in noise alone.
        share: its root mean square over the effort's.
        foretold: its evidence (2 ln L) in each stretch by the coefficients of all others, without the best stretch.
    """

    order: float
    against_motion: bool
    chance: float
    share: float
    foretold: float

    @property
    def is_there(self) -> bool:
        """Whether it is neither noise, nor next to nothing, nor of one stretch alone."""
        return self.chance <= CHANCE and self.foretold >= FORETOLD and self.share >= LEAST_OF_EFFORT


@dataclass(frozen=True)
class _Rows:
    """Weighted rows, how to whiten them, and what the model leaves of them.

    Attributes:
        position, speed, direction: of each row, shape (n,).
        weight: of each row, and what the model makes of a column where it bends, shape (n,).
        stretch: of each row, shape (n,).
        cutoff_rad_s: of the filter.
        whitening: of the rows.
        basis: orthonormal, of what the model explains, whitened, shape (n, b).
        residual: that it leaves, whitened, shape (n,).
    """

    position: FloatArray
    speed: FloatArray
    direction: FloatArray
    weight: FloatArray
    stretch: IntArray
    cutoff_rad_s: float
    whitening: Whitening
    basis: FloatArray
    residual: FloatArray

    @classmethod
    def of(cls, gathered: Candidates, base: Base, noise: Noise) -> "_Rows":
        """The tested rows on top of a base of theirs, as measured."""
        dataset, chosen = gathered.fit.dataset, gathered.rows

        def each(value: Callable[[Motion], FloatArray]) -> FloatArray:
            return dataset.rows_of([value(trial.motion) for trial in dataset.trials])[chosen]

        whitening = Whitening.of(noise)
        white = whitening.whitened(np.column_stack([base.basis, base.residual]))
        basis = orthonormal(white[:, :-1])
        return cls(
            each(lambda motion: motion.position),
            np.abs(each(lambda motion: motion.velocity)),
            each(lambda motion: motion.direction),
            gathered.weights * (1.0 + each(lambda motion: motion.bend)),
            dataset.block_index[chosen],
            2.0 * np.pi * dataset.cutoff_hz,
            whitening,
            basis,
            white[:, -1] - basis @ (basis.T @ white[:, -1]),
        )

    def columns(self, orders: FloatArray) -> FloatArray:
        """Cosines, then sines, of orders (m,) [rad per unit of position], filtered and weighted, shape (n, 2m)."""
        passed = 1.0 / (
            1.0 + (np.outer(self.speed, orders) / self.cutoff_rad_s) ** (2 * FILTER_ORDER)
        )  # there and back
        passed *= self.weight[:, None]
        phase = np.outer(self.position, orders)
        return np.concatenate([passed * np.cos(phase), passed * np.sin(phase)], axis=1)


def line_of(gathered: Candidates) -> Line | None:
    """The line that is least by chance; None where none is there for sure, or where the noise is not known."""
    if gathered.noise is None:
        return None
    base = gathered.as_measured(WITH_CHAIN)
    rows = _Rows.of(gathered, base, gathered.noise)
    orders = _orders(rows)
    portions = np.array_split(orders, -(-4 * len(orders) * len(rows.residual) // AT_ONCE))
    sizes = np.concatenate([_sizes(rows, some) for some in portions], axis=1)
    against, best = divmod(int(np.argmax(sizes)), len(orders))
    tries = sizes.size / STEPS
    chance = min(1.0, tries * gathered.noise.chance(float(sizes[against, best]), 2))
    if chance > CHANCE:
        return None
    columns = rows.columns(orders[best : best + 1]) * (rows.direction[:, None] if against else 1.0)
    coefficients, foretold = _foretold(rows, columns)
    own = columns @ coefficients
    beside = (own - base.basis @ (base.basis.T @ own)) / gathered.weights
    share = rms(beside) / rms(gathered.fit.dataset.effort[gathered.rows])
    cycles = 2.0 * np.pi if gathered.fit.dataset.facts.joint == "linear" else 1.0
    line = Line(float(orders[best]) / cycles, bool(against), chance, share, foretold)
    return line if line.is_there else None


def _orders(rows: _Rows) -> FloatArray:
    """From once over the travel to what the filter takes off even the slowest rows [rad per unit of position]."""
    once = 2.0 * np.pi / max(float(np.ptp(rows.position)), TINY)
    highest = rows.cutoff_rad_s / max(float(np.quantile(rows.speed, SLOW)), TINY)
    count = int(np.clip((highest / once - 1.0) * STEPS, 1.0, MOST_ORDERS))
    orders: FloatArray = once * (1.0 + np.arange(count) / STEPS)
    return orders


def _sizes(rows: _Rows, orders: FloatArray) -> FloatArray:
    """How far each order (m,) is beyond noise, as a force and against the motion, shape (2, m); chi-squared of two."""
    plain = rows.columns(orders)
    return np.array([_sizes_of(rows, plain), _sizes_of(rows, plain * rows.direction[:, None])])


def _sizes_of(rows: _Rows, columns: FloatArray) -> FloatArray:
    """Of cosines and sines (n, 2m); 0 where they cannot be told from the model, or from each other."""
    columns = rows.whitening.whitened(columns)
    taken = rows.basis.T @ columns
    whole = np.einsum("nk,nk->k", columns, columns)
    left = whole - np.einsum("bk,bk->k", taken, taken)
    half = columns.shape[1] // 2
    both = np.einsum("nk,nk->k", columns[:, :half], columns[:, half:])
    both -= np.einsum("bk,bk->k", taken[:, :half], taken[:, half:])
    (cosine, sine), (a, b) = np.split(rows.residual @ columns, 2), np.split(left, 2)
    area = a * b - both**2
    told = np.all(np.reshape(left > NEW * whole, (2, half)), axis=0) & (area > APART * a * b)
    size = (b * cosine**2 - 2.0 * both * cosine * sine + a * sine**2) / np.where(told, area, 1.0)
    found: FloatArray = np.where(told, size, 0.0)
    return found


def _foretold(rows: _Rows, columns: FloatArray) -> tuple[FloatArray, float]:
    """Coefficients of a line's columns (n, 2), and its evidence in each stretch by those of all others, but the best's.

    The evidence of coefficients c in a stretch is 2 c's - c'Nc, of its scores s and normal matrix N.
    """
    columns = rows.whitening.whitened(columns)
    columns = columns - rows.basis @ (rows.basis.T @ columns)
    _, label = np.unique(rows.stretch, return_inverse=True)
    count = int(label.max()) + 1
    scores = np.array([np.bincount(label, one * rows.residual, count) for one in columns.T]).T
    products = columns[:, :, None] * columns[:, None, :]
    normal = np.array([np.bincount(label, one, count) for one in products.reshape(-1, 4).T]).T.reshape(-1, 2, 2)
    others = np.linalg.pinv(normal.sum(axis=0) - normal) @ (scores.sum(axis=0) - scores)[:, :, None]
    gains = 2.0 * np.sum(others[:, :, 0] * scores, axis=1) - (others.transpose(0, 2, 1) @ normal @ others)[:, 0, 0]
    coefficients: FloatArray = np.linalg.pinv(normal.sum(axis=0)) @ scores.sum(axis=0)
    return coefficients, float(gains.sum() - gains.max())
