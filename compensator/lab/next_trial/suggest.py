"""The trials that would separate the rivals of a diagnosis most, chosen by predicted d' per minute."""

from collections.abc import Sequence
from math import inf

from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import widened
from compensator.lab.model.fitted import Fit
from compensator.lab.next_trial.breakaway_separation import BreakawaySeparation
from compensator.lab.next_trial.choice import Choice
from compensator.lab.next_trial.confounded import rivals_of, several
from compensator.lab.next_trial.rivalry import Rivalry
from compensator.lab.next_trial.separation import Separation
from compensator.lab.next_trial.suggestion import Option, Suggestion
from compensator.lab.screening.gathering import gather

SURE = 7.0  # d' from which a name is right every time; from 6 on nearly every time


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
    separation = _separation(fit, rivals)
    pairs = _pairs(separation, diagnosis)
    enough = SURE if diagnosis.verdict == "missing" else inf  # where nothing is sure, its d' is not sure either
    if several(diagnosis):  # d' that did not tell them apart is not enough
        enough = max(enough, 2.0 * min(separation.d_primes(separation.measured, pairs), default=0.0))
    return Choice(separation, options, pairs).made(most, enough)


def d_prime_of(fit: Fit, diagnosis: Diagnosis, name: str) -> float:
    """Smallest d' of one effect, taken for the truth, on the trials that were diagnosed.

    Against every effect that shows where it does; 0 where it is no candidate.
    """
    candidates = [one for one in diagnosis.candidates if one.effect.name == name]
    if not candidates:
        return 0.0
    separation = _separation(fit, candidates)
    pairs: list[tuple[int, int | None]] = [(0, None), *((0, rival) for rival in range(1, len(separation.rivals)))]
    return float(separation.d_primes(separation.measured, pairs).min())


def _separation(fit: Fit, rivals: list[Candidate]) -> Rivalry:
    """Of the rivals, on the rows where they show: in motion, or at starts from rest."""
    show_in = rivals[0].rows
    if show_in == "breakaway":
        return BreakawaySeparation(fit, rivals)
    wide = fit.dataset.choice_for([one.effect for one in rivals])
    gathered = gather(widened(fit, wide) if wide != fit.dataset.rows else fit, show_in)
    known = {block.name for block in gathered.named}
    named = [one for one in rivals if one.effect.name in known] or rivals[:1]
    of_one_kind = {name for name in known if effect_named(name).pipeline == named[0].effect.pipeline}
    return Separation(gathered, named, sorted(of_one_kind - {one.effect.name for one in named}))


def _pairs(separation: Rivalry, diagnosis: Diagnosis) -> list[tuple[int, int | None]]:
    """Each of the first rivals against every effect that could imitate it, and against nothing where that is possible.

    What comes after them in rank today may come before them tomorrow. A name that stands alone is the only one that is
    taken for the truth.
    """
    missing = diagnosis.verdict == "missing"
    true = range(1 if missing and not several(diagnosis) else separation.suspects)
    pairs: list[tuple[int, int | None]] = [(i, k) for i in true for k in range(len(separation.rivals)) if i != k]
    return pairs if missing else [*((i, None) for i in true), *pairs]
