"""Whether what a model leaves comes back with the position: order analysis, whatever the order, and the catalogue.

What turns with the joint, the motor or a wheel between them comes back after so much travel: an order, in cycles per
turn. A periodogram over the position, on rows whitened by the noise that a complete model would leave, holds cosine and
sine of every order against that noise, once as a force and once against the motion, as friction is (Lomb 1976, Scargle
1982: least squares at uneven places). Chance has as many tries as there are independent orders, twice.

Noise that is learnt from all that is left has a line in it, spread over a band, and so hides it. What may be a line is
looked at again, against noise that it has no part in.

A line in one stretch may be of time as well as of position, so that the others must foretell what each stretch holds.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.waves import Waves
from compensator.lab.left_over.white_rows import FORETOLD, LOOK_AGAIN, WhiteRows
from compensator.lab.model.held_out_error import rms
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.low_pass import FILTER_ORDER
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import VERY_STRONG

STEPS = 3.0  # per width of a line, so that none falls between two orders
MOST_ORDERS = 1500  # a joint of many turns is looked at up to so many
SLOW = 0.02  # share of the rows, the slowest: an order that even these pass too quickly for the filter cannot show
AT_ONCE = 2**21  # values of columns
NEW = 0.02  # share of a column's power beside the model: of less, little can be told from the model itself
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
        growing: its amplitude grows with the square of the speed.
    """

    order: float
    against_motion: bool
    chance: float
    share: float
    foretold: float
    growing: bool = False

    def is_there(self, most: float) -> bool:
        """Whether it is no noise, by the chance up to which it is none, nor next to nothing, nor of one stretch."""
        return self.chance <= most and self.foretold >= FORETOLD and self.share >= LEAST_OF_EFFORT


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

    def columns(self, orders: FloatArray) -> FloatArray:
        """Cosines, then sines, of orders (m,) [rad per unit of position], filtered and weighted, shape (n, 2m)."""
        over = np.outer(self.speed, orders) / self.cutoff_rad_s
        passed = 1.0 / (1.0 + over ** (2 * FILTER_ORDER))  # there and back
        passed *= self.weight[:, None]
        phase = np.outer(self.position, orders)
        return np.concatenate([passed * np.cos(phase), passed * np.sin(phase)], axis=1)


def line_of(
    gathered: Candidates, white: WhiteRows, most: float = PLAIN.line, look_again: float = LOOK_AGAIN
) -> Line | None:
    """The line that is least by chance; None where none is there for sure.

    Args:
        gathered: the model.
        white: its rows.
        most: chance in noise alone up to which it is none.
        look_again: the same in noise that is learnt with it, up to which one without it is asked.
    """
    path = _Path.of(gathered)
    orders, sizes = _scanned(path, white)
    against, best = divmod(int(np.argmax(sizes)), len(orders))
    tries = sizes.size / STEPS
    chance = min(1.0, tries * white.noise.chance(float(sizes[against, best]), 2))
    if chance > max(most, look_again):
        return None
    columns = path.columns(orders[best : best + 1]) * (path.direction[:, None] if against else 1.0)
    if most < chance <= look_again:
        white = white.cleared(gathered, columns)
        chance = min(1.0, tries * _chance(white, columns))
    line = _line(gathered, white, columns, float(orders[best]), chance)
    line = replace(line, against_motion=bool(against))
    return line if line.is_there(most) else None


def growing_line_of(gathered: Candidates, white: WhiteRows, most: float) -> Line | None:
    """The line of any order that grows with the square of the speed, and is likelier so; None where none is there.

    An angle that is misread round and round seems to be accelerated so; a force of any kind is as large when slow.

    Args:
        gathered: the model.
        white: its rows.
        most: chance in noise alone, over all orders, up to which it is none.
    """
    path = _Path.of(gathered)
    orders, steady = _scanned(path, white)
    growing = np.concatenate(
        [_sizes_of(white, path.columns(some) * path.speed[:, None] ** 2) for some in _portions(path, orders)]
    )
    best = int(np.argmax(growing))
    chance = min(1.0, len(orders) / STEPS * white.noise.chance(float(growing[best]), 2))
    if chance > most or growing[best] < steady.max() + VERY_STRONG:
        return None
    columns = path.columns(orders[best : best + 1]) * path.speed[:, None] ** 2
    line = replace(_line(gathered, white, columns, float(orders[best]), chance), growing=True)
    return line if line.is_there(most) else None


def _chance(white: WhiteRows, columns: FloatArray) -> float:
    """Of so much in noise alone at one order, by its cosine and sine (n, 2)."""
    beside = orthonormal(white.beside(columns))
    return white.noise.chance(float(np.sum((white.residual @ beside) ** 2)), max(beside.shape[1], 1))


def _line(gathered: Candidates, white: WhiteRows, columns: FloatArray, order: float, chance: float) -> Line:
    """The line of cosine and sine (n, 2) of an order [rad per unit of position]."""
    coefficients, foretold = white.foretold(white.beside(columns))
    own, basis = columns @ coefficients, gathered.as_measured(WITH_CHAIN).basis
    share = rms((own - basis @ (basis.T @ own)) / gathered.weights) / rms(gathered.fit.dataset.effort[gathered.rows])
    return Line(order / _cycle(gathered.fit.dataset), False, chance, share, foretold)


def _cycle(dataset: Dataset) -> float:
    """What an order is of, in rad per unit of position: a turn of a joint has 2 pi rad, a length has none."""
    return 2.0 * np.pi if dataset.facts.joint == "linear" else 1.0


def _orders(path: _Path) -> FloatArray:
    """From once over the travel to what the filter takes off even the slowest rows [rad per unit of position]."""
    once = 2.0 * np.pi / max(float(np.ptp(path.position)), TINY)
    highest = path.cutoff_rad_s / max(float(np.quantile(path.speed, SLOW)), TINY)
    count = int(np.clip((highest / once - 1.0) * STEPS, 1.0, MOST_ORDERS))
    orders: FloatArray = once * (1.0 + np.arange(count) / STEPS)
    return orders


def _scanned(path: _Path, white: WhiteRows) -> tuple[FloatArray, FloatArray]:
    """Every order (m,), and how far it is beyond noise as a force and against the motion, shape (2, m)."""
    orders = _orders(path)
    return orders, np.concatenate([_sizes(path, white, some) for some in _portions(path, orders)], axis=1)


def _portions(path: _Path, orders: FloatArray) -> list[FloatArray]:
    """So few orders at a time that their columns need little memory."""
    return np.array_split(orders, -(-4 * len(orders) * len(path.position) // AT_ONCE))


def _sizes(path: _Path, white: WhiteRows, orders: FloatArray) -> FloatArray:
    """How far each order (m,) is beyond noise, as a force and against the motion, shape (2, m); chi-squared of two."""
    plain = path.columns(orders)
    return np.array([_sizes_of(white, plain), _sizes_of(white, plain * path.direction[:, None])])


def _sizes_of(white: WhiteRows, columns: FloatArray) -> FloatArray:
    """Of cosines and sines (n, 2m); 0 where they cannot be told from the model, or from each other."""
    waves = Waves.of(white.whitening.whitened(columns), white.basis, white.residual)
    return waves.where(np.all(waves.left > NEW * waves.whole, axis=0))


def recurring_in_words(line: Line, facts: Facts) -> str:
    """What comes back with the position, how often, and where to look."""
    per = "a turn of the joint" if facts.joint == "rotary" else f"per {facts.position_unit}"
    way = ", against the motion" if line.against_motion else ", and grows with the speed" if line.growing else ""
    return f"comes back with the position about {line.order:.3g} times {per}{way}: look at what goes round so often"
