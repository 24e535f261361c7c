"""Trials that were suggested before and did not complete. They would trip again, so they are not suggested."""

import json
from collections.abc import Sequence

from bench.experiments.registry import whole_parameters
from bench.json_types import Values
from bench.store import Experiment, Store
from bench.study.models.study import note_for
from bench.study.suggestion.options import Choice
from bench.study.suggestion.suggested import Came, Suggested
from compensator.lab.effects.catalogue import effect_named

SHORT = 0.9  # of a d' that was predicted: less that came is told
CLOSER = (
    "The rivals are closer than the model said. Further trials are chosen by what came; if they bring less than was "
    "predicted again, take the rivals as one class, or let the bench move farther, faster, or under other loads."
)


def what_came(suggested: Suggested, next_suggested: Suggested) -> list[Came]:
    """Of each rival of a suggestion, the smallest d' that was predicted, and that the next suggestion begins with.

    Args:
        suggested: before the trials were recorded.
        next_suggested: the same after.
    """
    predicted = _smallest([(pair.true, pair.after) for pair in suggested.pairs])
    before = _smallest([(pair.true, pair.before) for pair in suggested.pairs])
    hopeless = _smallest([(pair.true, pair.before) for pair in next_suggested.hopeless])
    came = hopeless | _smallest([(pair.true, pair.before) for pair in next_suggested.pairs])
    return [
        Came(effect=name, before=before[name], predicted=value, came=came.get(name))
        for name, value in predicted.items()
    ]


def in_words(came: Sequence[Came]) -> str:
    """What came, and where it is less than was predicted, or than there was before, what that means."""
    parts = [f"{effect_named(one.effect).title}: {one.predicted:.1f} was predicted, {_came(one)}" for one in came]
    told = f"Smallest d' with these trials. {'; '.join(parts)}."
    if any(one.came is not None and (_fell(one) or one.came < SHORT * one.predicted) for one in came):
        told += f" {CLOSER}"
    return told


def _came(one: Came) -> str:
    if one.came is None:
        return "it is no rival any more"
    return f"{one.came:.1f} came" + (f", less than the {one.before:.1f} before" if _fell(one) else "")


def _fell(one: Came) -> bool:
    return one.came is not None and round(one.came, 1) < round(one.before, 1)


def _smallest(values: Sequence[tuple[str, float]]) -> dict[str, float]:
    found: dict[str, float] = {}
    for name, value in values:
        found[name] = min(found.get(name, value), value)
    return found


NOT_POSSIBLE = ("tripped", "failed")  # stopped by somebody, or with the process, it may be possible all the same


def kept_out(store: Store, study_id: int) -> list[Experiment]:
    """Experiments that a study asked for, that moved the joint and did not complete, nor later; oldest first."""
    found: dict[str, Experiment] = {}
    for one in reversed(store.experiments()):
        if one.note != note_for(study_id):
            continue
        if one.outcome == "completed":
            found.pop(_key(one.kind, one.parameters), None)
        elif one.outcome in NOT_POSSIBLE and any(trial.rows for trial in store.trials(one.id)):
            found[_key(one.kind, one.parameters)] = one
    return list(found.values())


def without(choices: list[Choice], experiments: list[Experiment]) -> list[Choice]:
    """The choices that are none of these experiments."""
    known = {_key(one.kind, one.parameters) for one in experiments}
    return [one for one in choices if _key(one.kind, whole_parameters(one.kind, one.parameters)) not in known]


def _key(kind: str, parameters: Values) -> str:
    return json.dumps([kind, parameters], sort_keys=True)
