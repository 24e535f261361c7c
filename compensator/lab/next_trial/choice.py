"""Trials chosen one by one, each that which tells most per minute of bench time."""

from collections.abc import Collection, Sequence

import numpy as np
from scipy.special import ndtr

from compensator.lab.model.held_out_error import rms
from compensator.lab.next_trial.rivalry import Equations, Rivalry
from compensator.lab.next_trial.suggestion import Option, Pair, Pick, Suggestion
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.assembly import more_trials, usable

LEAST_RISE = 0.05  # of d': less is not worth a trial
LEAST_FALL = 0.002  # of the mean chance of a wrong name: the same
DRAWS = 12  # of random trials, to hold the suggested ones against
HOPELESS = 2.0  # d' that even all options together do not reach: no trial of this bench tells the two apart


class Choice:
    """Greedy choice among options.

    Args:
        separation: of the rivals, and of what else could imitate them.
        options: trials that could be run.
        pairs: that are to be told apart: indices of truth and rival.
    """

    def __init__(self, separation: Rivalry, options: Sequence[Option], pairs: list[tuple[int, int | None]]) -> None:
        self._separation = separation
        dataset = separation.dataset
        found = [(option, usable(dataset, option.recordings)) for option in options]
        self._options = [option for option, recordings in found if recordings]
        self._brings = [separation.of_trials(more_trials(dataset, recordings)) for _, recordings in found if recordings]
        reachable = separation.d_primes(sum(self._brings, separation.measured), pairs)
        self._reachable = dict(zip(pairs, reachable.tolist(), strict=True))
        self._hopeless = [pair for pair in pairs if self._reachable[pair] < HOPELESS]
        self._pairs = [pair for pair in pairs if pair not in self._hopeless]

    def made(self, most: int, enough: float) -> Suggestion:
        """Pick until enough is separated, or nothing helps."""
        measured = known = self._separation.measured
        picks: list[Pick] = []
        while self._pairs and len(picks) < most and self._smallest(known) < enough:
            best = self._best(known, {pick.name for pick in picks})
            if best is None:
                break
            picks.append(self._pick(best, known))
            known = known + self._brings[best]
        drawn = self._drawn(len(picks))
        return Suggestion(
            pairs=tuple(self._pair(pair, measured, known, drawn) for pair in self._shown(measured, known)),
            hopeless=tuple(self._pair(pair, measured, known, drawn) for pair in self._hopeless),
            picks=tuple(picks),
            noise=float(np.sqrt(self._separation.noise_power)),
        )

    def _shown(self, *ends: Equations) -> list[tuple[int, int | None]]:
        """The rivals against each other and against nothing; of what else could imitate each, the nearest."""
        nearest = {
            min(others, key=lambda pair: self._separation.d_prime(equations, *pair))
            for equations in ends
            for true in range(self._separation.suspects)
            if (others := [pair for pair in self._pairs if pair[0] == true and not self._is_of_rivals(pair)])
        }
        return [pair for pair in self._pairs if self._is_of_rivals(pair) or pair in nearest]

    def _is_of_rivals(self, pair: tuple[int, int | None]) -> bool:
        return pair[1] is None or pair[1] < self._separation.suspects

    def _drawn(self, count: int) -> list[Equations]:
        """What is known with so many options drawn at random instead, a few times over; one may come again."""
        if count == 0:
            return [self._separation.measured]
        generator = np.random.default_rng(0)
        draws = [generator.integers(len(self._brings), size=count).tolist() for _ in range(DRAWS)]
        return [sum((self._brings[index] for index in drawn), self._separation.measured) for drawn in draws]

    def _all(self, equations: Equations) -> FloatArray:
        return self._separation.d_primes(equations, self._pairs)

    def _smallest(self, equations: Equations) -> float:
        return float(self._all(equations).min())

    def _best(self, known: Equations, picked: Collection[str]) -> int | None:
        """The option after which the chance of a wrong name falls most per minute; where it is small, d' rises most."""
        before = self._all(known)
        afters = [self._all(known + brings) for brings in self._brings]
        falls = [_risk(before) - _risk(after) for after in afters]
        rises = [float(after.min() - before.min()) for after in afters]
        minutes = [option.minutes for option in self._options]
        told = [option.once and option.name in picked for option in self._options]
        for gains, least in ((falls, LEAST_FALL), (rises, LEAST_RISE)):
            useful = [index for index, gain in enumerate(gains) if gain > least and not told[index]]
            if useful:
                return max(useful, key=lambda index: gains[index] / minutes[index])
        return None

    def _pick(self, index: int, known: Equations) -> Pick:
        option, brings = self._options[index], self._brings[index]
        after = known + brings
        d_prime = self._separation.d_prime
        most = max(self._pairs, key=lambda pair: d_prime(after, *pair) - d_prime(known, *pair))
        return Pick(
            name=option.name,
            minutes=option.minutes,
            before=self._smallest(known),
            after=self._smallest(after),
            pair=self._names(most),
            difference=self._separation.difference(known, brings, *most),
        )

    def _pair(
        self, pair: tuple[int, int | None], before: Equations, after: Equations, drawn: Sequence[Equations]
    ) -> Pair:
        true, rival = self._names(pair)
        now, then = (self._separation.d_prime(equations, *pair) for equations in (before, after))
        by_chance = rms(np.array([self._separation.d_prime(equations, *pair) for equations in drawn]))
        promised = self._separation.promised(after, *pair)
        return Pair(true, rival, now, then, self._reachable[pair], by_chance, promised)

    def _names(self, pair: tuple[int, int | None]) -> tuple[str, str | None]:
        rivals = self._separation.rivals
        return rivals[pair[0]].effect.name, None if pair[1] is None else rivals[pair[1]].effect.name


def _risk(d_primes: FloatArray) -> float:
    """Mean chance to take one of a pair for the other, each equally likely: half of d' lies between them."""
    return float(np.mean(ndtr(-0.5 * d_primes)))
