"""Trials that were suggested before and did not come to their end: what trips once trips again."""

import json

from bench.experiments.registry import find_kind, parse_parameters
from bench.json_types import Values
from bench.store import Experiment, Store
from bench.study.extend import note_for
from bench.study.suggestion.options import Choice

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
    return [one for one in choices if _key(one.kind, _all_parameters(one)) not in known]


def _all_parameters(choice: Choice) -> Values:
    """Also those that do not differ from the defaults, as they are kept with an experiment."""
    return parse_parameters(find_kind(choice.kind), choice.parameters).model_dump(mode="json")


def _key(kind: str, parameters: Values) -> str:
    return json.dumps([kind, parameters], sort_keys=True)
