"""Whether what a model leaves comes back with the position: order analysis, whatever the order, and the catalogue.

What turns with the joint, the motor or a wheel between them comes back after so much travel: an order, in cycles per
turn. A periodogram over the position holds cosine and sine of every order against those around, as a force and against
the motion, as friction is, beside all that the model and the chain explain (Lomb 1976, Scargle 1982: least squares at
uneven places). Chance has as many tries as there are independent orders, for each.

A line in one stretch may be of time as well as of position, so that the others must foretell what each stretch holds.
"""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.lines import TINY, chance_of_one, is_peak, over_noise
from compensator.lab.model.held_out_error import LEAST_OF_EFFORT, rms
from compensator.lab.model.order_search import FORCE, FRICTION, GROWING, STEPS, Path
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.base import Base
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import VERY_STRONG

REACH = (2.0, 40.0)  # widths: of a line to either side, and of noise that is smooth
NEGLIGIBLE = 1e-8  # share of a direction in what columns explain


@dataclass(frozen=True, slots=True)
class Line:
    """What comes back with the position.

    Attributes:
        order: cycles per turn; of a linear joint, cycles per unit of position.
        rad_per_position: the same in rad per unit of position, as shapes of effects have it.
        tried: independent orders that it is the best of.
        kind: a force, friction, or what grows with the square of the speed.
        chance: of such a line at any order, in noise alone.
        share: its root mean square over the effort's.
    """

    order: float
    rad_per_position: float
    tried: int
    kind: str
    chance: float
    share: float


def line_of(gathered: Candidates, most: float = PLAIN.line, most_growing: float = PLAIN.growing) -> Line | None:
    """The line that is least by chance; None where none is there for sure, of more than one stretch.

    An angle that is misread round and round seems to be accelerated so: it grows with the square of the speed, as no
    force does, and has to be likelier so.

    Args:
        gathered: the model.
        most: chance in noise alone, over all orders and both kinds, up to which a force, or friction, is none.
        most_growing: the same of what grows with the speed.
    """
    dataset, base = gathered.fit.dataset, gathered.as_measured(WITH_CHAIN)
    path = Path.of(dataset, gathered.rows, gathered.weights)
    orders = path.orders
    sizes = path.scanned(base.basis, base.residual, orders, (FORCE, FRICTION, GROWING))
    tries = len(orders) / STEPS
    both = [_peak(path, base, sizes[kind], kind, 2.0 * tries, most) for kind in (FORCE, FRICTION)]
    peaks = [one for one in both if one is not None]
    best = min(peaks, key=lambda one: one.chance, default=None)
    if best is not None and min(1.0, 2.0 * tries * best.chance) <= most:
        return _line(gathered, path, base, best, 2.0 * tries)
    growing = _peak(path, base, sizes[GROWING], GROWING, tries, most_growing)
    if growing is None or tries * growing.chance > most_growing:
        return None
    steady = max(float(sizes[kind].max()) for kind in (FORCE, FRICTION))
    likelier = float(sizes[GROWING].max()) >= steady + VERY_STRONG * growing.noise
    return _line(gathered, path, base, growing, tries) if likelier else None


def with_found_order(gathered: Candidates) -> Candidates:
    """The candidates, and what comes back with the position for sure: wheels between motor and joint have any order.

    Each effect that goes round is one at that order, too, and pays for all that were looked at.
    """
    dataset = gathered.fit.dataset
    first = {block.name: block for block in reversed(gathered.named) if effect_named(block.name).goes_round}
    line = line_of(gathered) if first else None
    if line is None or line.kind == GROWING:
        return gathered
    shape = (line.rad_per_position,)
    made = dataset.columns_of_effects([(effect_named(name), [shape]) for name in first])
    found = [
        replace(one, columns=gathered.tested(columns), scanned=one.scanned + line.tried, shape=shape)
        for one, (columns,) in zip(first.values(), made, strict=True)
    ]
    return replace(gathered, named=[*gathered.named, *found])


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


def _peak(path: Path, base: Base, sizes: FloatArray, kind: str, tries: float, most: float) -> _Peak | None:
    """Of the sizes (m,) of all orders; None where none stands out by so many tries.

    The noise at an order is what is left around with the line in the model: where only the slowest rows show it, it
    spreads over many orders.

    Args:
        path: of the rows.
        base: the model.
        sizes: of the kind.
        kind: of the line.
        tries: independent orders, of all kinds, that it is the best of.
        most: chance in noise alone, over all of them, up to which it is none.
    """
    orders = path.orders
    over, _ = over_noise(orders, sizes[None], np.ones(1), (REACH[0] * path.once, REACH[1] * path.once))
    standing_out = np.where(is_peak(sizes), over[0], 0.0)
    if not standing_out.any():
        return None
    best = int(np.argmax(standing_out))
    around = orders[np.abs(orders - orders[best]) <= REACH[1] * path.once]
    beside = base.extended(path.factor(kind) * path.columns(orders[best : best + 1]))
    left = path.scanned(beside.basis, beside.residual, around, (kind,))[kind]
    noise = 0.5 * float(np.mean(left[left > 0.0])) if left.any() else TINY  # of two
    # over noise that were known for sure, the chance would be the least; what follows takes longest
    if min(1.0, tries * float(np.exp(-float(sizes[best]) / (2.0 * noise)))) > most:
        return None
    columns = beside.beyond(path.factor(kind) * path.columns(around))[:, np.tile(left > 0.0, 2)]
    chance = chance_of_one(float(sizes[best]) / (2.0 * noise), 0.5 * independent_of(columns))
    order = path.refined(base.basis, base.residual, float(orders[best]), kind)
    return _Peak(kind, order, chance, noise)


def independent_of(columns: FloatArray) -> float:
    """How many independent directions columns (n, k) have: of the powers p of principal ones, (sum p)^2 / sum p^2.

    Orders that only a part of the travel shows are alike over many; the noise beside one is known from fewer.
    """
    if not columns.size:
        return 0.0
    own = columns / np.maximum(np.linalg.norm(columns, axis=0), TINY)
    alike = own.T @ own
    return float(len(alike) ** 2 / np.sum(alike**2))


def _line(gathered: Candidates, path: Path, base: Base, peak: _Peak, tries: float) -> Line | None:
    """The line of a peak, of as many that were tried; None where it is next to nothing, or of one stretch."""
    columns = path.factor(peak.kind) * path.columns(np.array([peak.order]))
    left = base.beyond(columns)
    _, stretch = np.unique(gathered.fit.dataset.block_index[gathered.rows], return_inverse=True)
    coefficients, foretold = foretold_by_others(left, base.residual, stretch.reshape(-1))
    share = rms(left @ coefficients / gathered.weights) / rms(gathered.fit.dataset.effort[gathered.rows])
    if foretold < 2.0 * VERY_STRONG * peak.noise or share < LEAST_OF_EFFORT:
        return None
    cycle = 2.0 * np.pi if gathered.fit.dataset.facts.joint == "linear" else 1.0  # rad per rad are cycles per turn
    chance = min(1.0, tries * peak.chance)
    return Line(peak.order / cycle, peak.order, round(tries), peak.kind, chance, share)


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


def recurring_in_words(line: Line, facts: Facts) -> str:
    """What comes back with the position, how often, and where to look."""
    per = "a turn of the joint" if facts.joint == "rotary" else f"per {facts.position_unit}"
    way = {FORCE: "", FRICTION: ", against the motion", GROWING: ", and grows with the speed"}[line.kind]
    return f"comes back with the position about {line.order:.3g} times {per}{way}: look at what goes round so often"
