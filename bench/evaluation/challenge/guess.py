"""A guess at what is hidden: names of effects, classes of names, "nothing" or "none-of-these"."""

from collections.abc import Iterable
from dataclasses import dataclass

from bench.errors import ParameterError
from bench.evaluation.challenge.names import RECORDED, accepted
from bench.store import Store
from bench.study.diagnosis.diagnose import diagnose
from bench.study.ladder import ladder
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.errors import UnknownEffectError

NOTHING = "nothing"
UNKNOWN = "none-of-these"
UNKNOWN_TOO = "none_of_these"  # as effects are spelt
OUTSIDE = ("unknown-effect", "unexplained")  # what a diagnosis concludes where something is left that has no name


@dataclass(frozen=True, slots=True)
class Guess:
    """What somebody says is hidden.

    Attributes:
        classes: effects that are said to be there. A class of several names says: one of these.
        unknown: something is said to be there that no effect of the catalogue stands for. A provisional curve says so.
    """

    classes: tuple[tuple[str, ...], ...] = ()
    unknown: bool = False

    @classmethod
    def parse(cls, text: str) -> "Guess":
        """Read `name[,name]`; `name/name` is a class; `nothing`; `none-of-these`, which `none_of_these` means, too.

        Raises:
            ParameterError: an unknown name, or `nothing` beside something.
        """
        parts = [UNKNOWN if part.strip() == UNKNOWN_TOO else part.strip() for part in text.split(",") if part.strip()]
        if not parts or (NOTHING in parts and len(parts) > 1):
            raise ParameterError(
                f"guess is '{text}'; wanted {NOTHING}, {UNKNOWN}, effects such as spring,viscous_asymmetry, or a class "
                "of effects such as spring/gravity"
            )
        named = [_known(tuple(part.split("/"))) for part in parts if part not in (NOTHING, UNKNOWN)]
        return cls.of(named, UNKNOWN in parts)

    @classmethod
    def of(cls, classes: Iterable[tuple[str, ...]], unknown: bool) -> "Guess":
        """A guess of names as a model has them: a curve names a variable and no mechanism, so it counts as unknown."""
        parts = [tuple(name for name in one if not effect_named(name).provisional) for one in classes]
        return cls(tuple(filter(None, parts)), unknown or not all(parts))

    @property
    def words(self) -> list[str]:
        """Each an effect, a class joined by '/', or none-of-these; empty where nothing is said to be there."""
        return ["/".join(names) for names in self.classes] + [UNKNOWN] * self.unknown

    @property
    def text(self) -> str:
        """As `parse` reads it."""
        return ",".join(self.words) or NOTHING


@dataclass(frozen=True, slots=True)
class Score:
    """How good a guess is.

    Attributes:
        right: hidden mechanisms that were named, alone or in a class; "none-of-these" for one outside the catalogue.
        missed: hidden mechanisms that were not.
        untold: hidden mechanisms that no recording of motion can tell from what every model has; they do not count.
        recorded: names that hold for every recording, whatever is hidden; they do not count.
        wrong: classes said to be there that are not.
        class_sizes: of the classes that hold a right name.
        faint: hidden mechanisms of which the recordings hold less than a diagnosis may name; they do not count.
    """

    right: tuple[str, ...]
    missed: tuple[str, ...]
    untold: tuple[str, ...]
    recorded: tuple[str, ...]
    wrong: tuple[str, ...]
    class_sizes: tuple[int, ...]
    faint: tuple[str, ...] = ()

    @property
    def perfect(self) -> bool:
        """Whether everything was named and nothing else."""
        return not (self.missed or self.wrong)

    @property
    def points(self) -> float:
        """One for each mechanism named, shared by the class it was named in; less one for each false name."""
        outside = len(self.right) - len(self.class_sizes)
        return sum(1.0 / size for size in self.class_sizes) + outside - len(self.wrong)


def score(truths: Iterable[str], guess: Guess, absorbed: Iterable[str] = (), faint: Iterable[str] = ()) -> Score:
    """Hold a guess against the names of the hidden mechanisms; those in `absorbed` and `faint` need not be named."""
    left = list(guess.classes)
    right: list[str] = []
    others: list[str] = []
    sizes: list[int] = []
    unknown_used = False
    for truth in truths:
        names = accepted(truth)
        found = [one for one in left if set(one) & set(names)]
        if found:
            left = [one for one in left if one not in found]  # two shares of one mechanism are both right
            right.append(truth)
            sizes.append(len(found[0]))
        elif not names and guess.unknown:
            unknown_used = True
            right.append(truth)
        else:
            others.append(truth)
    untold = [truth for truth in others if truth in absorbed]
    too_faint = [truth for truth in others if truth in faint and truth not in untold]
    missed = [truth for truth in others if truth not in (*untold, *too_faint)]
    recorded = ["/".join(one) for one in left if set(one) <= set(RECORDED)]
    wrong = ["/".join(one) for one in left if not set(one) <= set(RECORDED)]
    if guess.unknown and not unknown_used:
        wrong.append(UNKNOWN)
    return Score(
        tuple(right), tuple(missed), tuple(untold), tuple(recorded), tuple(wrong), tuple(sizes), tuple(too_faint)
    )


def guess_of_study(store: Store, study_id: int) -> Guess:
    """What a study says is hidden: what it added, and what its last diagnosis names, unless it calls that slight.

    A provisional curve among what it added says: something that no effect of the catalogue stands for.

    Raises:
        NotFoundError: there is no such study.
        StudyError: its last model cannot be judged.
    """
    rungs = ladder(store, study_id).rungs
    last = diagnose(store, study_id)
    added = [(name,) for name in rungs[-1].effects if name not in rungs[0].effects]
    named = [] if last.slight else [tuple(one.effects) for one in last.classes]
    return Guess.of([*added, *named], last.conclusion.code in OUTSIDE)


def _known(names: tuple[str, ...]) -> tuple[str, ...]:
    try:
        return tuple(effect_named(name.strip()).name for name in names)
    except UnknownEffectError as error:
        raise ParameterError(
            f"guess: wanted {NOTHING}, {UNKNOWN} or effects; {error}; list them with: friction-bench effects"
        ) from error
