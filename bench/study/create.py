"""Create a study, describe it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bench.config.rig import Rig
from bench.recording_set.transfer import is_by_control_loop
from bench.store import Store
from bench.store.records import Trial
from bench.study.errors import StudyError, lab_errors
from bench.study.keep import judged
from bench.study.material import Definition, Material, facts_of, load, material_of
from bench.study.models.stages import CHANGE, FITTING, JUDGING
from bench.study.models.study import ModelName, Study
from bench.study.selection import keep, split, without
from compensator.lab import progress
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.recordings.bandwidth import check_cutoff, choose_cutoff_hz
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.processing import lowest_cutoff_hz
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.dataset import RowChoice


@progress.stages(CHANGE)
def create_study(
    store: Store,
    name: str,
    experiment_ids: Sequence[int],
    hold_out: Sequence[str] = (),
    base: Sequence[str] | None = None,
    where: Sequence[str] = (),
    cutoff_hz: float | None = None,
    rows: RowChoice = "sliding",
    leave_out: Sequence[str] = (),
) -> Study:
    """Fix the trials of a study and fit its base model.

    Args:
        store: with the experiments.
        name: of the study.
        experiment_ids: whose trials are used.
        hold_out: criteria `key=value`; trials that meet one judge the model instead of being fitted.
        base: effects of the first model; None takes the rigid joint with General Kinetic Friction.
        where: criteria that every trial used must meet.
        cutoff_hz: of the final low-pass [Hz]; None lets the data choose, and leaves out trials too short for it.
        rows: "sliding", "moving" or "all".
        leave_out: names of trials that are not used.

    Raises:
        StudyError: an empty name, no usable trials, a criterion that fits none, different rigs, an unknown effect.
    """
    if not name.strip():
        raise StudyError("the study's name is empty; wanted is one character or more, as in `study new winter`")
    read: dict[int, Recording] = {}
    definition = definition_of(store, experiment_ids, hold_out, base, where, cutoff_hz, rows, read, leave_out)
    return _create(store, name, definition, read)


def definition_of(
    store: Store,
    experiment_ids: Sequence[int],
    hold_out: Sequence[str] = (),
    base: Sequence[str] | None = None,
    where: Sequence[str] = (),
    cutoff_hz: float | None = None,
    rows: RowChoice = "sliding",
    read: dict[int, Recording] | None = None,
    leave_out: Sequence[str] = (),
) -> Definition:
    """What a study is made of; arguments and errors as `create_study`; `read` gets the recordings of all trials."""
    if cutoff_hz is not None and not 0.0 < cutoff_hz < float("inf"):
        raise StudyError(f"cutoff_hz is {cutoff_hz:g} Hz; wanted is more than 0 Hz, or nothing to let the data choose")
    where = (*where, *without(_trials(store, experiment_ids), leave_out))
    trials = _trials(store, experiment_ids, where)
    facts = _facts(store, experiment_ids)
    with lab_errors():
        recordings = [store.recording(trial.id) for trial in progress.each(trials)]
        if read is not None:
            read.update(zip((trial.id for trial in trials), recordings, strict=True))
        told = all(LOAD in one.channels and bool(np.isfinite(one.channels[LOAD]).any()) for one in recordings)
        effects = _base_effects(base) if base else base_model(store, experiment_ids, facts, told)
        if cutoff_hz:
            check_cutoff(cutoff_hz, recordings)
        cutoff = cutoff_hz or choose_cutoff_hz(recordings, choose_effort(recordings, facts), facts)
    used = trials if cutoff_hz else _long_enough(trials, recordings, cutoff)
    held = split(used, hold_out)
    return Definition(
        trial_ids=tuple(trial.id for trial in used),
        held_out=tuple(held),
        base=effects,
        cutoff_hz=cutoff,
        rows=rows,
        facts=facts,
        experiment_ids=tuple(experiment_ids),
        hold_out=tuple(hold_out),
        where=tuple(where),
        too_short=tuple(trial.id for trial in trials if trial not in used),
    )


def describe(store: Store, study_id: int) -> Study:
    """A study: its trials with their roles, its effort, its models."""
    return _describe(store, load(store, study_id))


def _create(store: Store, name: str, definition: Definition, read: dict[int, Recording]) -> Study:
    draft = material_of(store, 0, name, definition, read)
    if any(definition.held_out) and not (draft.dataset.counted & ~draft.training).any():
        raise StudyError(
            f"the trials of hold-out {', '.join(definition.hold_out)} have no row that counts ({definition.rows}); "
            "hold out trials in which the joint moves, or count more rows"
        )
    progress.enter(FITTING)
    fit = draft.fit(list(definition.base))
    progress.enter(JUDGING)
    result = judged(fit)  # before anything is kept: a study has a model from the start
    material = replace(draft, study_id=store.create_study(name, definition.to_json()))
    store.add_model(material.study_id, None, list(fit.names), result)
    return _describe(store, material)


def _describe(store: Store, material: Material) -> Study:
    models = store.models(material.study_id)
    return Study(
        study_id=material.study_id,
        name=material.name,
        effort=material.effort,
        cutoff_hz=material.definition.cutoff_hz,
        rows=material.definition.rows,
        trials=material.study_trials,
        left_out=[store.trial(number).name for number in material.definition.too_short],
        models=[ModelName(model_id=one.id, parent_id=one.parent_id, effects=one.effects) for one in models],
        model_id=models[-1].id,
    )


def _base_effects(base: Sequence[str]) -> tuple[str, ...]:
    for effect in base:
        if base.count(effect) > 1:
            raise StudyError(f"{effect} stands twice in the base model {', '.join(base)}; name each effect once")
    return tuple(effect_named(effect).name for effect in base)


def _trials(store: Store, experiment_ids: Sequence[int], where: Sequence[str] = ()) -> list[Trial]:
    """Completed trials of experiments that meet every criterion, in order."""
    if not experiment_ids:
        raise StudyError("no experiment named; a study needs the trials of at least one")
    found = []
    for experiment_id in dict.fromkeys(experiment_ids):
        store.experiment(experiment_id)  # says which are there if this one is not
        found += [trial for trial in store.trials(experiment_id) if trial.outcome == "completed" and trial.rows]
    if not found:
        raise StudyError(
            "these experiments have no completed trial with samples; run them to the end, or choose others"
        )
    return keep(sorted(found, key=lambda trial: trial.id), where)


def _long_enough(trials: list[Trial], recordings: Sequence[Recording], cutoff_hz: float) -> list[Trial]:
    """The trials that a cut-off leaves anything of; all where it leaves none, for the error to be raised."""
    pairs = zip(trials, recordings, strict=True)
    kept = [trial for trial, recording in pairs if lowest_cutoff_hz(recording) <= cutoff_hz]
    return kept or trials


def _facts(store: Store, experiment_ids: Sequence[int]) -> Facts:
    found = {number: facts_of(Rig.model_validate(store.experiment(number).rig)) for number in experiment_ids}
    if len(set(found.values())) > 1:
        raise StudyError(
            f"experiments {', '.join(map(str, found))} are of different rigs; a study is about one: "
            "make one study for each"
        )
    return next(iter(found.values()))


LOAD = "load_torque_n_m"
SAMPLING_DELAY = "measurement_delay"


def base_model(
    store: Store, experiment_ids: Sequence[int], facts: Facts, load_is_measured: bool = False
) -> tuple[str, ...]:
    """Rigid joint with General Kinetic Friction; of our own control loop, with its sampling delay.

    The loop samples the position at the end of the cycle whose effort stands in the same row: on average the effort
    is half a period older. That is how the rows are made, no property of the joint that a diagnosis should name.

    Args:
        store: with the experiments.
        experiment_ids: whose trials are used.
        facts: of their rig.
        load_is_measured: by a torque sensor, in every trial.
    """
    experiments = [store.experiment(number) for number in experiment_ids]
    own = all(map(is_by_control_loop, experiments))
    effects = default_effects(facts, load_is_measured)
    return (*effects, SAMPLING_DELAY) if own else effects
