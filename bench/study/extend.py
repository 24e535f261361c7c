"""More trials for a study: recorded because it asked for them, or named by the user."""

from collections.abc import Sequence
from dataclasses import replace

from bench.config.rig import Rig
from bench.store import Store
from bench.store.records import Trial
from bench.study.errors import NothingNewError, StudyError
from bench.study.keep import keep_model, kept_of
from bench.study.material import Definition, facts_of, load, material_of, model_of
from bench.study.models.stages import CHANGE, FITTING, JUDGING
from bench.study.models.study import AddedTrial, Extended, note_for
from bench.study.selection import Criterion
from compensator.lab import progress
from compensator.lab.diagnosis.data_checks import some_of
from compensator.lab.rows.assembly import usable


@progress.stages(CHANGE)
def extend_study(store: Store, study_id: int, experiment_ids: Sequence[int] = ()) -> Extended:
    """Add trials to a study and refit its newest model to all of them.

    Trials that meet a hold-out criterion of the study judge the model, the others are fitted. Earlier models stay what
    they were: they are compared and diagnosed on the trials that they were fitted to.

    Args:
        store: with study and experiments.
        study_id: which study.
        experiment_ids: whose trials are added; none: every completed one that was run for the study.

    Raises:
        NotFoundError: no such study or experiment.
        NothingNewError: nothing new is there.
        StudyError: an experiment is of another rig.
    """
    row = store.study(study_id)
    definition = Definition.from_json(row.definition)
    numbers = list(experiment_ids) or _run_for(store, study_id)
    dataset = load(store, study_id).dataset
    new = [trial for number in numbers for trial in _new_trials(store, number, definition)]
    trials = [trial for trial in new if usable(dataset, [store.recording(trial.id)])]
    if not trials:
        names = some_of([f"'{trial.name}'" for trial in new])
        unusable = f" ({names}: too short for its filter, or without its effort or position)" if new else ""
        raise NothingNewError(
            f"there is no completed trial that study {study_id} can use and has not yet{unusable}; run those that "
            f"`study suggest {study_id}` names, or name other experiments"
        )
    before = model_of(store, study_id, None)
    longer = _with(definition, numbers, trials)
    material = material_of(store, study_id, row.name, longer)
    progress.enter(FITTING)
    fit = material.fit(before.effects)  # before anything is kept
    progress.enter(JUDGING)
    store.change_study(study_id, longer.to_json())
    model_id = keep_model(store, study_id, before.id, fit)
    errors = kept_of(before).held_out, kept_of(store.model(model_id)).held_out
    return Extended(
        study_id=study_id,
        model_id=model_id,
        added=[AddedTrial(trial_id=trial.id, name=trial.name) for trial in trials],
        left_out=[trial.name for trial in new if trial not in trials],
        trials=len(material.trials),
        before=errors[0],
        after=errors[1],
        sentence=_sentence(len(trials), *errors),
    )


def _run_for(store: Store, study_id: int) -> list[int]:
    wanted = note_for(study_id)
    return sorted(one.id for one in store.experiments(outcome="completed") if one.note == wanted)


def _new_trials(store: Store, experiment_id: int, definition: Definition) -> list[Trial]:
    facts = facts_of(Rig.model_validate(store.experiment(experiment_id).rig))
    if facts != definition.facts:
        raise StudyError(f"experiment {experiment_id} is of another rig than the study; make a study of its own for it")
    found = [trial for trial in store.trials(experiment_id) if trial.outcome == "completed" and trial.rows]
    return [trial for trial in found if trial.id not in definition.trial_ids]


def _with(definition: Definition, experiment_ids: Sequence[int], trials: Sequence[Trial]) -> Definition:
    criteria = [Criterion.parse(text) for text in definition.hold_out]
    held = [any(criterion.matches(trial) for criterion in criteria) for trial in trials]
    return replace(
        definition,
        trial_ids=(*definition.trial_ids, *(trial.id for trial in trials)),
        held_out=(*definition.held_out, *held),
        experiment_ids=tuple(dict.fromkeys((*definition.experiment_ids, *experiment_ids))),
    )


def _sentence(added: int, before: float, after: float) -> str:
    return (
        f"{added} trial{'s' * (added != 1)} added; the same effects, fitted to all, leave a held-out "
        f"error of {after:.2%} ({before:.2%} on the trials before)."
    )
