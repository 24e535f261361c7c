"""How well trials tell two effects apart, and would if others were added: predicted d'.

Each of two rivals is fitted to the effort that the other predicts. What that leaves of it tells them apart:

    d'^2 = n / v ln(1 + |M_0 z_j|^2 / (n s^2)) |M_k z_j|^2 / |M_0 z_j|^2

z_j is what effect j adds to the effort, as fitted; M_0 takes out what the model and the measuring chain can make of it,
M_k what effect k can at its best shape, too; s^2 is the weighted residual's power, n the rows, v those per independent
row. It is the d' of a diagnosis: the noise is learnt from the same rows, so that evidence grows with the logarithm.
All of it follows from the normal equations, which add up over trials: what a trial would bring costs one small solve.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.effects.effect import Effect, Shape
from compensator.lab.next_trial.projected import Projected
from compensator.lab.next_trial.sizes import chance_of, possible_sizes, promised
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset


@dataclass(frozen=True)
class Rival:
    """An effect that may be the missing one.

    Attributes:
        effect: which.
        shape: its best shape; coefficients: as fitted freely at that shape, shape (k,).
        shapes: those that it may take to imitate another.
        sizes: coefficients that the rows allow a suspect, shape (draws, k); chance: that it is there at all.
    """

    effect: Effect
    shape: Shape
    coefficients: FloatArray
    shapes: tuple[Shape, ...]
    sizes: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    chance: float = 0.0


@dataclass(frozen=True)
class Equations:
    """Normal equations of some rows: they add up.

    Attributes:
        rows: how many.
        gram: of all columns, shape (K, K).
    """

    rows: int
    gram: FloatArray

    def __add__(self, other: "Equations") -> "Equations":
        return Equations(self.rows + other.rows, self.gram + other.gram)


class Rivalry(ABC):
    """Predicted d' between rivals from normal equations, whatever the rows are.

    Columns stand in this order: the model's, the measuring chain's, every shape of every rival's.

    Attributes:
        rivals: effects that may be the missing one, and after them those that could only imitate one of these.
        suspects: how many may be the missing one.
        noise_power: of the weighted residual once the first of them is in the model.
        measured: what the rows of the diagnosis say.
    """

    rivals: list[Rival]
    suspects: int
    noise_power: float
    measured: Equations
    _inflation: list[float]  # rows per independent row, for each rival
    _nuisance: tuple[str, ...]
    _model: int  # columns
    _stretches: int  # that the noise is known from

    @property
    @abstractmethod
    def dataset(self) -> Dataset:
        """Of the diagnosed model."""

    @abstractmethod
    def of_trials(self, dataset: Dataset) -> Equations:
        """Normal equations that trials to come would add, by the model's own prediction."""

    @staticmethod
    @abstractmethod
    def _stands_in(rival: Rival) -> frozenset[str]:
        """Columns of the measuring chain that stand for this rival, and are left out beside it."""

    def d_prime(self, equations: Equations, true: int, rival: int | None) -> float:
        """d' of one rival if it is the truth, against another by its index; None: against nothing being missing."""
        return float(self.d_primes(equations, [(true, rival)])[0])

    def d_primes(self, equations: Equations, pairs: Sequence[tuple[int, int | None]]) -> FloatArray:
        """The same of many pairs, shape (p,): what the model can make is taken out once for all."""
        known: dict[frozenset[str], Projected] = {}
        found = np.empty(len(pairs))
        for number, (true, rival) in enumerate(pairs):
            standing_in = self._standing_in(true, rival)
            if standing_in not in known:
                known[standing_in] = Projected(equations.gram, self._base(standing_in), self._first_effect)
            sized = self.rivals[true].coefficients
            found[number] = self._squared(known[standing_in], equations.rows, true, rival, sized)
        return np.sqrt(found)

    def promised(self, equations: Equations, true: int, rival: int | None) -> float:
        """The d' that is reached in nine of ten of the cases that the measured rows allow."""
        projected = Projected(equations.gram, self._base(self._standing_in(true, rival)), self._first_effect)
        one = self.rivals[true]
        squared = [self._squared(projected, equations.rows, true, rival, sized) for sized in one.sizes]
        return float(np.sqrt(promised(np.array(squared), one.chance, self._stretches)))

    def _sized(self, candidates: Sequence[Candidate], ranges: Sequence[Sequence[tuple[float, float]]]) -> list[Rival]:
        """The rivals, each suspect with the sizes that the measured rows allow it within its bounds."""
        found = list(self.rivals)
        for true, (candidate, bounds) in enumerate(zip(candidates, ranges, strict=True)):
            one, own = found[true], self._own[true]
            base = self._base(self._standing_in(true, None))
            covariance = Projected(self.measured.gram, base, self._first_effect).inverse(own)
            error = self._inflation[true] * self.noise_power * covariance
            sizes = possible_sizes(one.coefficients, error, bounds)
            chance = chance_of(candidate.score)
            found[true] = replace(one, sizes=sizes, chance=chance)
        return found

    def _squared(self, projected: Projected, rows: int, true: int, rival: int | None, sized: FloatArray) -> float:
        power = projected.power(self._own[true], sized)
        if power == 0.0:
            return 0.0
        gain = rows / self._inflation[true] * np.log1p(power / (rows * self.noise_power))
        return float(gain * self._left(projected, true, rival, sized) / power)

    def difference(self, known: Equations, brings: Equations, true: int, rival: int | None) -> float:
        """What a trial adds to what remains when the rival is fitted to the effort that the truth predicts.

        Fitted to that trial alone, the model would take up nearly all of it: what is known holds the model in place.

        Args:
            known: without the trial.
            brings: what the trial adds.
            true: index of the rival taken for the truth.
            rival: of the one that is fitted; None: nothing being missing.

        Returns:
            Root mean square over the rows of the trial, in the effort's unit.
        """
        more = self.remaining(known + brings, true, rival) - self.remaining(known, true, rival)
        return float(np.sqrt(max(more, 0.0) / max(brings.rows, 1)))

    def remaining(self, equations: Equations, true: int, rival: int | None) -> float:
        """The least power that the model and the rival, at any of its shapes, leave of the truth's part."""
        base = self._base(self._standing_in(true, rival))
        projected = Projected(equations.gram, base, self._first_effect)
        return self._left(projected, true, rival, self.rivals[true].coefficients)

    def _left(self, projected: Projected, true: int, rival: int | None, sized: FloatArray) -> float:
        own = self._own[true]
        power = projected.power(own, sized)
        if rival is None:
            return power
        return max(power - projected.most_absorbed(self._shaped[rival], own, sized), 0.0)

    def _standing_in(self, true: int, rival: int | None) -> frozenset[str]:
        """Columns of the measuring chain that stand in for the one or the other."""
        own = self._stands_in(self.rivals[true])
        return own if rival is None else own | self._stands_in(self.rivals[rival])

    def _base(self, standing_in: frozenset[str]) -> IntArray:
        """Columns of the model and of the measuring chain, less those that stand in for a rival."""
        kept = [i for i, name in enumerate(self._nuisance) if name not in standing_in]
        return np.concatenate([np.arange(self._model), self._model + np.array(kept, dtype=np.int64)])

    @property
    def _first_effect(self) -> int:
        """The first column that is none of the model or the measuring chain."""
        return self._model + len(self._nuisance)

    @cached_property
    def _shaped(self) -> list[IntArray]:
        """Columns of each rival's shapes among those of all effects, shape (shapes, k)."""
        found, start = [], 0
        for one in self.rivals:
            width, count = len(one.coefficients), len(one.shapes)
            found.append(start + np.arange(width * count).reshape(count, width))
            start += width * count
        return found

    @cached_property
    def _own(self) -> list[IntArray]:
        """Indices of the columns of each rival at its best shape."""
        return [columns[one.shapes.index(one.shape)] for one, columns in zip(self.rivals, self._shaped, strict=True)]


MOST_HELD = 0.9  # of an effect's power in one stretch, beyond which the others tell nothing of that one's scatter


def rows_per_independent_row(own: FloatArray, left: FloatArray, stretch: IntArray) -> float:
    """From how an effect's share of what is left differs between stretches.

    What neighbouring rows have in common does not see slow scatter: friction that is another one each time, a mean that
    drifts. Sums over whole stretches do (Liang, Zeger 1986). A stretch that holds much of an effect has drawn its size
    to itself and leaves little of its own scatter: each is judged by the size that the others give (jackknife: Bell,
    McCaffrey 2002).

    Args:
        own: what the effect adds to the effort beyond the model, as fitted, weighted, shape (n,).
        left: weighted residual with the effect in the model, shape (n,).
        stretch: of each row, shape (n,).

    Returns:
        Variance of the fitted size over that which independent rows would give; 1 where the effect adds nothing.
    """
    _, labels = np.unique(stretch, return_inverse=True)
    sums, powers = np.bincount(labels, weights=own * left), np.bincount(labels, weights=own**2)
    expected = float(np.mean(left**2) * powers.sum())
    if expected == 0.0:
        return 1.0
    alone = sums / (1.0 - np.minimum(powers / powers.sum(), MOST_HELD))
    return float(np.sum(alone**2)) / expected
