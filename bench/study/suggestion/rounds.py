"""Trials in rounds: a few are suggested and recorded, then the rivals are named anew; what trips is replaced.

Two trials may bring up a new rival, or settle what six were planned for. A sequential design needs fewer trials than
one that is made beforehand (Box and Hill 1967).
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

AT_ONCE = 2  # trials of a round
MOST_FAILED = 3  # trials that do not complete before somebody should look at the bench


class Named(Protocol):
    """A trial that could be recorded."""

    @property
    def name(self) -> str:
        """Unique among all that could be."""


Trial = TypeVar("Trial", bound=Named)


@dataclass(frozen=True, slots=True)
class Tried:
    """A trial that was started.

    Attributes:
        reason: why it did not complete; empty where it did.
    """

    name: str
    reason: str = ""


class Ended(Exception):
    """Raised by what runs a trial: nothing more is to be started."""


def in_rounds(
    ask: Callable[[int, Collection[str]], Sequence[Trial]],
    run: Callable[[Trial], str],
    learn: Callable[[], None],
    most: int,
    at_once: int = AT_ONCE,
) -> list[Tried]:
    """Suggest, record and learn until nothing more is suggested, or so many trials completed.

    One that trips, or is refused, is kept out, and the next best takes its place.

    Args:
        ask: how many at most, and names that are kept out -> trials, best first; none where nothing is to be told.
        run: one trial to its end; returns why it did not complete, or an empty string. Raises `Ended` where nothing
            more shall start.
        learn: called after each round that brought something, also before the end by `Ended`.
        most: trials that complete.
        at_once: trials of a round.

    Returns:
        Every trial that was started, in order.
    """
    tried: list[Tried] = []
    while sum(not one.reason for one in tried) < most and len(_kept_out(tried)) < MOST_FAILED:
        left = most - sum(not one.reason for one in tried)
        offered = ask(min(left, at_once), _kept_out(tried))
        if not offered:
            break
        before, ended = len(tried), False
        for trial in offered:
            try:
                tried.append(Tried(trial.name, run(trial)))
            except Ended as why:
                tried.append(Tried(trial.name, str(why)))
                ended = True
            if ended or len(_kept_out(tried)) == MOST_FAILED:
                break
        if any(not one.reason for one in tried[before:]):
            learn()
        if ended:
            break
    return tried


def _kept_out(tried: Sequence[Tried]) -> frozenset[str]:
    return frozenset(one.name for one in tried if one.reason)
