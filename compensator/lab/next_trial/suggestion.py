"""What to record next, and what it is predicted to tell."""

from dataclasses import dataclass

from compensator.lab.recordings.recording import Recording


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
