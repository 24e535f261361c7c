"""Whether what a model leaves comes back with the position: order analysis, whatever the order, and the catalogue.

What turns with the joint, the motor or a wheel between them comes back after so much travel: an order, in cycles per
turn. A periodogram over the position holds cosine and sine of every order against those around, as a force and against
the motion, as friction is, beside all that the model and the chain explain (Lomb 1976, Scargle 1982: least squares at
uneven places). Chance has as many tries as there are independent orders, for each.

A line in one stretch may be of time as well as of position, so that the others must foretell what each stretch holds.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.lines import TINY, chance_of_one, is_peak, over_noise
from compensator.lab.left_over.waves import Waves
from compensator.lab.model.held_out_error import rms
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.low_pass import FILTER_ORDER
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Base
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import VERY_STRONG

STEPS = 4.0  # per width of a line, as of those in time
MOST_ORDERS = 2000  # a joint of many turns is looked at up to so many
REACH = (2.0, 40.0)  # widths: of a line to either side, and of noise that is smooth
SLOW = 0.02  # share of the rows, the slowest: an order that even these pass too quickly for the filter cannot show
AT_ONCE = 2**21  # values of columns
NEW = 0.02  # share of a column's power beside the model: of less, little can be told from the model itself
FORETOLD = 20.0  # evidence, as 2 ln L, of what all other stretches foretell of each, the best one left out
LEAST_OF_EFFORT = 0.0005  # root mean square: no sensor is more linear
NEGLIGIBLE = 1e-8  # share of a direction in what columns explain


@dataclass(frozen=True, slots=True)
class Line:
    """What comes back with the position.

    Attributes:
        order: cycles per turn; of a linear joint, cycles per unit of position.
        kind: a force, friction, or what grows with the square of the speed.
        chance: of such a line at any order, in noise alone.
        share: its root mean square over the effort's.
        foretold: its evidence (2 ln L) in each stretch by the coefficients of all others, without the best stretch.
    """

    order: float
    kind: str
    chance: float
    share: float
    foretold: float


KINDS = FORCE, FRICTION, GROWING = ("force", "against the motion", "grows with the speed")


@dataclass(frozen=True)
class _Path:
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
    def of(cls, gathered: Candidates) -> "_Path":
        """Of the tested rows."""
        dataset = gathered.fit.dataset

        def each(value: Callable[[Motion], FloatArray]) -> FloatArray:
            return dataset.rows_of([value(trial.motion) for trial in dataset.trials])[gathered.rows]

        return cls(
            each(lambda motion: motion.position),
            np.abs(each(lambda motion: motion.velocity)),
            each(lambda motion: motion.direction),
            gathered.weights * (1.0 + each(lambda motion: motion.bend)),
            2.0 * np.pi * dataset.cutoff_hz,
        )

    @property
    def once(self) -> float:
        """The width of a line: once over the travel [rad per unit of position]."""
        return float(2.0 * np.pi / max(float(np.ptp(self.position)), TINY))

    @property
    def orders(self) -> FloatArray:
        """From once over the travel to what the filter takes off even the slowest rows [rad per unit of position]."""
        highest = self.cutoff_rad_s / max(float(np.quantile(self.speed, SLOW)), TINY)
        count = int(np.clip((highest / self.once - 1.0) * STEPS, 1.0, MOST_ORDERS))
        orders: FloatArray = self.once * (1.0 + np.arange(count) / STEPS)
        return orders

    def columns(self, orders: FloatArray) -> FloatArray:
        """Cosines, then sines, of orders (m,) [rad per unit of position], filtered and weighted, shape (n, 2m)."""
        passed = 1.0 / (1.0 + (np.outer(self.speed, orders) / self.cutoff_rad_s) ** (2 * FILTER_ORDER))  # both ways
        passed *= self.weight[:, None]
        phase = np.outer(self.position, orders)
        return np.concatenate([passed * np.cos(phase), passed * np.sin(phase)], axis=1)

    def factor(self, kind: str) -> FloatArray:
        """Of such columns of one kind, shape (n, 1)."""
        factors = {FORCE: np.ones_like(self.speed), FRICTION: self.direction, GROWING: self.speed**2}
        return factors[kind][:, None]


def line_of(gathered: Candidates, most: float = PLAIN.line, most_growing: float = PLAIN.growing) -> Line | None:
    """The line that is least by chance; None where none is there for sure, of more than one stretch.

    An angle that is misread round and round seems to be accelerated so: it grows with the square of the speed, as no
    force does, and has to be likelier so.

    Args:
        gathered: the model.
        most: chance in noise alone, over all orders and both kinds, up to which a force, or friction, is none.
        most_growing: the same of what grows with the speed.
    """
    path, base = _Path.of(gathered), gathered.as_measured(WITH_CHAIN)
    orders = path.orders
    sizes = _scanned(path, base, orders, KINDS)
    peaks = [one for kind in (FORCE, FRICTION) if (one := _peak(path, base, sizes[kind], kind)) is not None]
    tries = len(orders) / STEPS
    best = min(peaks, key=lambda one: one.chance, default=None)
    if best is not None and min(1.0, 2.0 * tries * best.chance) <= most:
        return _line(gathered, path, base, best, 2.0 * tries)
    growing = _peak(path, base, sizes[GROWING], GROWING)
    if growing is None or tries * growing.chance > most_growing:
        return None
    steady = max(float(sizes[kind].max()) for kind in (FORCE, FRICTION))
    likelier = float(sizes[GROWING].max()) >= steady + VERY_STRONG * growing.noise
    return _line(gathered, path, base, growing, tries) if likelier else None


@dataclass(frozen=True)
class _Peak:
    """The order that stands out most.

    Attributes:
        kind: of the line.
        order: in rad per unit of position.
        chance: of so much at this order, in noise alone.
        noise: mean square of what it puts into a direction.
    """

    kind: str
    order: float
    chance: float
    noise: float


def _scanned(path: _Path, base: Base, orders: FloatArray, kinds: Sequence[str]) -> dict[str, FloatArray]:
    """What cosine and sine of orders (m,) gain together beside the model, each kind of shape (m,)."""
    sizes: dict[str, list[FloatArray]] = {kind: [] for kind in kinds}
    for some in np.array_split(orders, -(-2 * len(orders) * len(path.position) // AT_ONCE)):
        columns = path.columns(some)
        for kind, found in sizes.items():
            waves = Waves.of(path.factor(kind) * columns, base.basis, base.residual)
            found.append(waves.where(np.all(waves.left > NEW * waves.whole, axis=0)))
    return {kind: np.concatenate(found) for kind, found in sizes.items()}


def _peak(path: _Path, base: Base, sizes: FloatArray, kind: str) -> _Peak | None:
    """Of the sizes (m,) of all orders; None where none stands out.

    The noise at an order is what is left around with the line in the model: where only the slowest rows show it, it
    spreads over many orders.
    """
    orders = path.orders
    over, _ = over_noise(orders, sizes[None], np.ones(1), (REACH[0] * path.once, REACH[1] * path.once))
    standing_out = np.where(is_peak(sizes), over[0], 0.0)
    if not standing_out.any():
        return None
    best = int(np.argmax(standing_out))
    around = orders[np.abs(orders - orders[best]) <= REACH[1] * path.once]
    beside = base.extended(path.factor(kind) * path.columns(orders[best : best + 1]))
    left = _scanned(path, beside, around, (kind,))[kind]
    noise = 0.5 * float(np.mean(left[left > 0.0])) if left.any() else TINY  # of two
    chance = chance_of_one(float(sizes[best]) / (2.0 * noise), np.count_nonzero(left) / STEPS)
    return _Peak(kind, float(orders[best]), chance, noise)


def _line(gathered: Candidates, path: _Path, base: Base, peak: _Peak, tries: float) -> Line | None:
    """The line of a peak, of as many that were tried; None where it is next to nothing, or of one stretch."""
    columns = path.factor(peak.kind) * path.columns(np.array([peak.order]))
    left = columns - base.basis @ (base.basis.T @ columns)
    _, stretch = np.unique(gathered.fit.dataset.block_index[gathered.rows], return_inverse=True)
    coefficients, foretold = foretold_by_others(left, base.residual, stretch.reshape(-1))
    share = rms(left @ coefficients / gathered.weights) / rms(gathered.fit.dataset.effort[gathered.rows])
    if foretold < FORETOLD * peak.noise or share < LEAST_OF_EFFORT:
        return None
    order = peak.order / _cycle(gathered.fit.dataset)
    return Line(order, peak.kind, min(1.0, tries * peak.chance), share, foretold / peak.noise)


def foretold_by_others(columns: FloatArray, residual: FloatArray, stretch: np.ndarray) -> tuple[FloatArray, float]:
    """Coefficients of columns (n, k) beside the model; what they explain of each stretch by those of all others.

    Of coefficients c that is 2 c's - c'Nc, of the stretch's scores s and normal matrix N. The best stretch is left out:
    what is in one alone may be of that moment.
    """
    count, size = int(stretch.max()) + 1, columns.shape[1]
    scores = np.array([np.bincount(stretch, one * residual, count) for one in columns.T]).T
    products = (columns[:, :, None] * columns[:, None, :]).reshape(-1, size**2)
    normal = np.array([np.bincount(stretch, one, count) for one in products.T]).T.reshape(-1, size, size)
    whole, sums = normal.sum(axis=0), scores.sum(axis=0)
    others = (np.linalg.pinv(whole - normal, rcond=NEGLIGIBLE) @ (sums - scores)[:, :, None])[:, :, 0]
    evidence = 2.0 * np.sum(others * scores, axis=1) - np.einsum("si,sij,sj->s", others, normal, others)
    coefficients: FloatArray = np.linalg.pinv(whole, rcond=NEGLIGIBLE) @ sums
    return coefficients, float(evidence.sum() - evidence.max())


def _cycle(dataset: Dataset) -> float:
    """What an order is of, in rad per unit of position: a turn of a joint has 2 pi rad, a length has none."""
    return 2.0 * np.pi if dataset.facts.joint == "linear" else 1.0


def recurring_in_words(line: Line, facts: Facts) -> str:
    """What comes back with the position, how often, and where to look."""
    per = "a turn of the joint" if facts.joint == "rotary" else f"per {facts.position_unit}"
    way = {FORCE: "", FRICTION: ", against the motion", GROWING: ", and grows with the speed"}[line.kind]
    return f"comes back with the position about {line.order:.3g} times {per}{way}: look at what goes round so often"
