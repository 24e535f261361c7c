"""The trials that would separate the rivals of a diagnosis most, chosen one by one by predicted d' per minute."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.special import ndtr

from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import rms
from compensator.lab.next_trial.breakaway_separation import BreakawaySeparation
from compensator.lab.next_trial.separation import Equations, Rivalry, Separation
from compensator.lab.recordings.recording import FloatArray, Recording
from compensator.lab.rows.assembly import more_trials, usable
from compensator.lab.screening.candidates import gather

SURE = 7.0  # d' from which a name is right every time; from 6 on nearly every time
MOST_RIVALS = 4
RUNNERS_UP = 3  # that are looked at where no class of several is named
LEAST_RISE = 0.05  # of d': less is not worth a trial
LEAST_FALL = 0.002  # of the mean chance of a wrong name: the same
DRAWS = 12  # of random trials, to hold the suggested ones against
HOPELESS = 2.0  # d' that even all options together do not reach: no trial of this bench tells the two apart


@dataclass(frozen=True)
class Option:
    """A trial that the bench could run.

    Attributes:
        name: unique among the options.
        minutes: of bench time.
        recordings: what it would show, by the model fitted so far: motion, conditions, effort.
        once: again, it would show the very same samples.
    """

    name: str
    minutes: float
    recordings: tuple[Recording, ...]
    once: bool = False


@dataclass(frozen=True, slots=True)
class Pair:
    """Two rivals, the first taken for the truth; the second None where nothing being missing is the rival.

    Attributes:
        before, after: predicted d' on the trials measured, and with all that are suggested.
        reachable: predicted d' with every option together.
        by_chance: root mean square of the predicted d' with as many options drawn at random.
        promised: d' with all that are suggested, reached in nine of ten of the cases that the trials measured allow.
    """

    true: str
    rival: str | None
    before: float
    after: float
    reachable: float
    by_chance: float
    promised: float


@dataclass(frozen=True, slots=True)
class Pick:
    """One suggested trial.

    Attributes:
        name: of the option; minutes: of bench time.
        before, after: smallest predicted d' of the pairs without it and with it, the earlier picks included.
        pair: the one that it separates most: truth and rival.
        difference: root mean square of what the two predict differently in it, in the effort's unit.
    """

    name: str
    minutes: float
    before: float
    after: float
    pair: tuple[str, str | None]
    difference: float


@dataclass(frozen=True)
class Suggestion:
    """What to record next.

    Attributes:
        pairs: rivals that are to be separated; hopeless: those that no option separates.
        picks: trials, in the order they were chosen.
        noise: root mean square of the noise that they are predicted against, in the effort's unit, weighted.
    """

    pairs: tuple[Pair, ...]
    hopeless: tuple[Pair, ...]
    picks: tuple[Pick, ...]
    noise: float


def suggest(fit: Fit, diagnosis: Diagnosis, options: Sequence[Option], most: int = 6) -> Suggestion:
    """Choose trials that raise the smallest predicted d' of the leading rivals most, per minute of bench time.

    Args:
        fit: the diagnosed model.
        diagnosis: of it.
        options: trials that could be run.
        most: how many are chosen at most; fewer where something is named and d' reaches `SURE`.

    Raises:
        UnusableDataError: the diagnosis ranks no effect.
    """
    rivals = rivals_of(diagnosis)
    if not rivals:
        raise UnusableDataError("the diagnosis ranks no effect: there is nothing to separate; record any motion first")
    separation = _separation(_as_judged(fit, diagnosis), rivals)
    pairs = _pairs(separation, diagnosis)
    enough = SURE if diagnosis.verdict == "missing" else inf  # where nothing is sure, its d' is not sure either
    if _several(diagnosis):  # d' that did not tell them apart is not enough
        enough = max(enough, 2.0 * min(separation.d_primes(separation.measured, pairs), default=0.0))
    return _Choice(separation, options, pairs).made(most, enough)


def d_prime_of(fit: Fit, diagnosis: Diagnosis, name: str) -> float:
    """Smallest d' of one effect, taken for the truth, on the trials that were diagnosed.

    Against every effect that shows where it does; 0 where it is no candidate.
    """
    candidates = [one for one in diagnosis.candidates if one.effect.name == name]
    if not candidates:
        return 0.0
    separation = _separation(_as_judged(fit, diagnosis), candidates)
    pairs: list[tuple[int, int | None]] = [(0, None), *((0, rival) for rival in range(1, len(separation.rivals)))]
    return float(separation.d_primes(separation.measured, pairs).min())


def _as_judged(fit: Fit, diagnosis: Diagnosis) -> Fit:
    """The model at the shapes that the diagnosis judged it at."""
    return fit if diagnosis.shapes is None else fit_model(fit.dataset, fit.names, fit.training, diagnosis.shapes)


def _separation(fit: Fit, rivals: list[Candidate]) -> Rivalry:
    """Of the rivals, on the rows where they show: in motion, or at starts from rest."""
    show_in = rivals[0].rows
    if show_in == "breakaway":
        return BreakawaySeparation(fit, rivals)
    wide = fit.dataset.choice_for([one.effect for one in rivals])
    gathered = gather(widened(fit, wide) if wide != fit.dataset.rows else fit, show_in)
    known = {(block.name, block.key) for block in gathered.named}
    rivals = [one for one in rivals if (one.effect.name, one.shape) in known]
    named = {one.effect.name for one in rivals}
    of_one_kind = [name for name, _ in known if effect_named(name).pipeline == rivals[0].effect.pipeline]
    return Separation(gathered, rivals, sorted({*of_one_kind} - named))


def rivals_of(diagnosis: Diagnosis) -> list[Candidate]:
    """The class that is named; where it has one member, or nothing is named, the next in rank too. One family alone.

    Where nothing is sure, starts from rest may speak for an effect while motion speaks for none: they need trials of
    their own, so that then these are the rivals.
    """
    named = set(diagnosis.classes[0]) if diagnosis.verdict == "missing" else set()
    first = diagnosis.candidates[:1]
    if first and not named:
        from_rest = [one for one in diagnosis.candidates if one.rows == "breakaway" and _speaks_for_itself(one)]
        first = sorted([*first, *from_rest], key=lambda one: -one.score)[:1]
    family = [one for one in diagnosis.candidates if _of_one_kind(one, first[0])] if first else []
    members = [one for one in family if one.effect.name in named]
    return members[:MOST_RIVALS] if len(members) > 1 else family[:RUNNERS_UP]


def _speaks_for_itself(candidate: Candidate) -> bool:
    """Whether a candidate that is not sure pays for its parameters, can be it, and would lower the held-out error."""
    return candidate.score > 0.0 and candidate.physical and candidate.gain.value > 0.0


def _several(diagnosis: Diagnosis) -> bool:
    """Whether a class of several effects is named."""
    return diagnosis.verdict == "missing" and len(diagnosis.classes[0]) > 1


def shows_from_rest(diagnosis: Diagnosis) -> bool:
    """Whether the rivals of a diagnosis are told apart by starts from rest."""
    return any(one.rows == "breakaway" for one in rivals_of(diagnosis)[:1])


def _risk(d_primes: FloatArray) -> float:
    """Mean chance to take one of a pair for the other, each equally likely: half of d' lies between them."""
    return float(np.mean(ndtr(-0.5 * d_primes)))


def _of_one_kind(candidate: Candidate, first: Candidate) -> bool:
    return (candidate.rows, candidate.effect.pipeline) == (first.rows, first.effect.pipeline)


def _pairs(separation: Rivalry, diagnosis: Diagnosis) -> list[tuple[int, int | None]]:
    """Each of the first rivals against every effect that could imitate it, and against nothing where that is possible.

    What comes after them in rank today may come before them tomorrow. A name that stands alone is the only one that is
    taken for the truth.
    """
    missing = diagnosis.verdict == "missing"
    true = range(1 if missing and not _several(diagnosis) else separation.suspects)
    pairs: list[tuple[int, int | None]] = [(i, k) for i in true for k in range(len(separation.rivals)) if i != k]
    return pairs if missing else [*((i, None) for i in true), *pairs]


class _Choice:
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
