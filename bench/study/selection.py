"""Which trials a study uses, and which of them judge the model instead of being fitted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from bench.store.records import Trial
from bench.study.errors import StudyError
from compensator.lab.recordings.recording import Condition

MOST_SHOWN = 12


@dataclass(frozen=True, slots=True)
class Criterion:
    """`key=value[,value ...]`: the key is a condition, `trial` (its name), `trial_id` or `kind`."""

    key: str
    values: tuple[str, ...]

    @classmethod
    def parse(cls, text: str) -> "Criterion":
        """Read `key=value`.

        Raises:
            StudyError: not of that form.
        """
        key, equals, values = text.partition("=")
        if not (key.strip() and equals and values.strip()):
            raise StudyError(f"'{text}' is no criterion; wanted key=value, for instance load_kg=0.1 or trial=pulses")
        return cls(key.strip(), tuple(value.strip() for value in values.split(",")))

    def matches(self, trial: Trial) -> bool:
        """Whether the trial has one of the values."""
        return self.holds({"trial": trial.name, "kind": trial.kind, "trial_id": trial.id, **trial.conditions})

    def holds(self, known: Mapping[str, Condition]) -> bool:
        """Whether what is known of a trial, by key, has one of the values."""
        found = known.get(self.key)
        return found is not None and any(_same(found, value) for value in self.values)


def _same(found: object, wanted: str) -> bool:
    if isinstance(found, bool):
        return wanted.lower() == str(found).lower()
    if isinstance(found, int | float):
        try:
            return abs(float(wanted) - found) <= 1e-9 * max(1.0, abs(found))
        except ValueError:
            return False
    return wanted == found


def split(trials: Sequence[Trial], hold_out: Sequence[str]) -> list[bool]:
    """True for each trial that is held out.

    Raises:
        StudyError: a criterion matches no trial, or all trials would be held out.
    """
    criteria = [Criterion.parse(text) for text in hold_out]
    for criterion, text in zip(criteria, hold_out, strict=True):
        if not any(criterion.matches(trial) for trial in trials):
            raise StudyError(f"no trial has {text}; {_known(trials, criterion.key)}")
    held = [any(criterion.matches(trial) for criterion in criteria) for trial in trials]
    if all(held):
        raise StudyError(
            f"hold-out {', '.join(hold_out)} takes all {len(trials)} trials; leave some to fit the model to"
        )
    return held


def _known(trials: Sequence[Trial], key: str) -> str:
    """What could have been asked for: the values of a key that the trials have, else their keys."""
    values = sorted({f"{one.conditions[key]}" for one in trials if key in one.conditions})
    if values:
        return f"these trials have {key} = {_some(values)}"
    keys = sorted({"trial", "kind", "trial_id"}.union(*(trial.conditions for trial in trials)))
    return f"the keys of these trials are: {', '.join(keys)}"


def keep(trials: Sequence[Trial], where: Sequence[str]) -> list[Trial]:
    """Trials that meet every criterion.

    Raises:
        StudyError: none does.
    """
    criteria = [Criterion.parse(text) for text in where]
    kept = [trial for trial in trials if all(criterion.matches(trial) for criterion in criteria)]
    if not kept:
        raise StudyError(f"no trial of these experiments has {' and '.join(where) or 'samples'}")
    return kept


def without(trials: Sequence[Trial], names: Sequence[str]) -> list[str]:
    """The criterion that all trials meet but those of some names; none where no name is given.

    By number, and not by name: a name may have a comma in it.

    Raises:
        StudyError: no trial has such a name, or none is left.
    """
    if not names:
        return []
    there = list(dict.fromkeys(trial.name for trial in trials))
    for name in names:
        if name not in there:
            near = get_close_matches(name, there, n=3)
            told = f"the nearest are: {', '.join(near)}" if near else f"there are: {_some(there)}"
            raise StudyError(f"leave out: no trial of these experiments is called '{name}'; {told}")
    left = [str(trial.id) for trial in trials if trial.name not in names]
    if not left:
        raise StudyError(f"leave out: that takes all {len(trials)} trials; leave some to fit the model to")
    return [f"trial_id={','.join(left)}"]


def _some(values: Sequence[str]) -> str:
    return ", ".join(values[:MOST_SHOWN]) + (" ..." if len(values) > MOST_SHOWN else "")
