"""Whether trials can carry a model, before a study is made of them: how much motion they hold for each parameter."""

from collections.abc import Sequence

import numpy as np

from bench.store import Store
from bench.store.records import Condition, Trial
from bench.study.create import definition_of
from bench.study.material import material_of
from bench.study.models.coverage import Checked
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.recordings.repeats import NOT_CONDITIONS, REPEAT

ROWS_PER_PARAMETER = 20
"""Rows in which the joint slides, for each parameter: with fewer, the fit follows the noise. Load sweeps and steps rest
most of the time and have 5 to 15, with held-out errors without meaning; identification motions have 30 and more."""
FEWEST_VALUES = 3


def check_trials(
    store: Store, experiment_ids: Sequence[int], hold_out: Sequence[str] = (), where: Sequence[str] = ()
) -> Checked:
    """What `create_study` would have to fit with. Nothing is kept.

    Raises:
        StudyError: as `create_study`.
    """
    material = material_of(store, 0, "check", definition_of(store, experiment_ids, hold_out, None, where))
    counted = material.dataset.counted & material.training
    rows = int(np.count_nonzero(counted))
    parameters = sum(len(effect_named(name).parameters) for name in material.definition.base)
    moving = {material.trials[index].name for index in np.unique(material.dataset.trial_index[counted])}
    training = [t for t, held in zip(material.trials, material.definition.held_out, strict=True) if not held]
    still = list(dict.fromkeys(trial.name for trial in training if trial.name not in moving))
    carries = rows >= ROWS_PER_PARAMETER * parameters
    criterion, advice = _advice(material.trials)
    return Checked(
        carries=carries,
        sentence=_sentence(rows, parameters, still, carries),
        rows=rows,
        parameters=parameters,
        still=still,
        hold_out=criterion,
        advice=advice,
    )


def _sentence(rows: int, parameters: int, still: Sequence[str], carries: bool) -> str:
    found = f"The joint slides in {rows} rows of these trials, for {parameters} parameters"
    if carries:
        return f"{found}: enough to fit a model."
    least = ROWS_PER_PARAMETER * parameters
    rest = f" In {len(still)} of them it does not slide at all." if still else ""
    return (
        f"{found}: too few, about {least} are wanted, and errors of such a model mean nothing.{rest} "
        "Record motion: an identification motion, a chirp, or steady speeds."
    )


def _advice(trials: Sequence[Trial]) -> tuple[str, str]:
    """The condition with the most values, of which a middle one judges between those that are fitted."""
    values: dict[str, set[Condition]] = {}
    for trial in trials:
        for key, value in trial.conditions.items():
            if isinstance(value, float) and not key.endswith("_s") and key not in NOT_CONDITIONS:
                values.setdefault(key, set()).add(value)
    several = {key: sorted(found, key=float) for key, found in values.items() if len(found) >= FEWEST_VALUES}
    if several:
        key, found = max(several.items(), key=lambda item: len(item[1]))
        if len(found) < len(trials):
            middle = found[len(found) // 2]
            return f"{key}={middle:g}", "a value between others: the model is judged where it was not fitted"
    if len({trial.conditions.get(REPEAT) for trial in trials} - {None}) > 1:
        return "repeat=2", "a repeat: it tells whether the model holds again, not whether it holds elsewhere"
    return "", "nothing to hold out: each trial is left out in turn"
