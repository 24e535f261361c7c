"""Several effects at once: search, and keep every model on the way as a rung of the ladder."""

from bench.store import Store
from bench.study.diagnosis.diagnose import answer_of, explained_by, outset_of, root_of
from bench.study.diagnosis.findings import findings_of_trials
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.diagnosis.last_words import last_words, share_left
from bench.study.errors import lab_errors
from bench.study.joint import joint_of
from bench.study.keep import gain_of, kept_of, result_of, stored
from bench.study.material import load, model_of
from bench.study.models.base import ROWS_IN_WORDS, STARTS
from bench.study.models.change import Searched, SearchStep
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.stages import DIAGNOSING, LOADED
from compensator.lab import progress
from compensator.lab.diagnosis.search import MOST_EFFECTS, Step, stages_of
from compensator.lab.diagnosis.search import search as search_from


def search(store: Store, study_id: int, model_id: int | None = None, most: int = MOST_EFFECTS) -> Searched:
    """Add effects one after the other as long as a diagnosis names one that is not slight; each time judge all anew.

    Args:
        store: with the study.
        study_id: which study.
        model_id: the model to begin with; None takes the newest.
        most: effects that are added at most.

    Raises:
        StudyError: no such model, or no effect can be judged on these trials.
    """
    return search_and_diagnose(store, study_id, model_id, most)[0]


def search_and_diagnose(
    store: Store, study_id: int, model_id: int | None = None, most: int = MOST_EFFECTS
) -> tuple[Searched, Diagnosis]:
    """As `search`, and what its last model lacks beside the effects that other trials did not bear out."""
    with progress.stages((*LOADED, DIAGNOSING, *stages_of(most))):
        return _searched(store, study_id, model_id, most)


def _searched(store: Store, study_id: int, model_id: int | None, most: int) -> tuple[Searched, Diagnosis]:
    material = load(store, study_id)
    progress.enter(DIAGNOSING)
    first = model_of(store, study_id, model_id)
    fit = material.fit_of(first)
    with lab_errors():
        found = search_from(fit, most, diagnosis_of_model(material, first, fit), outset_of(store, first))
    parent, before = first.id, kept_of(first).held_out
    steps: list[SearchStep] = []
    for step in found.steps:
        result = result_of(step.fit, step.held_out)
        if (one := step.judged) is not None:
            result = result.model_copy(update={"gain": gain_of(one.rows, one.before, one.after, one.gain)})
        child = store.add_model(study_id, parent, list(step.fit.names), stored(result))
        steps.append(
            SearchStep(
                model_id=child,
                change=step.change,
                effect=step.effect,
                instead_of=step.instead_of,
                before=before,
                after=step.held_out.relative,
                rivals=list(step.rivals),
                sentence=_sentence(step, before),
            )
        )
        parent, before = child, step.held_out.relative
    root = root_of(store, first)
    added = [name for name in found.fit.names if name not in root.effects]
    explained, joint = explained_by(store, model_of(store, study_id, parent)), joint_of(store, material.definition)
    last = answer_of(found.fit, found.last, study_id, parent, explained, joint)
    searched = Searched(
        study_id=study_id,
        model_id=parent,
        added=list(found.added),
        steps=steps,
        verdict=last.verdict,
        conclusion=last.conclusion,
        offered=last.offered,
        slight=last.slight,
        sentence=last_words(last, added, share_left(kept_of(root).held_out, before)),
        findings=findings_of_trials(found.fit, joint),
    )
    return searched, last


_ELSEWHERE = {"moving": ROWS_IN_WORDS["moving"], "breakaway": STARTS}  # of which the ladder's errors say nothing
_DONE = {"add": "Added", "swap": "Took", "drop": "Dropped"}


def _sentence(step: Step, before: float) -> str:
    instead = f" instead of {step.instead_of}" if step.instead_of else ""
    errors, after = "held-out error", step.held_out.relative
    if step.judged is not None and step.judged.rows in _ELSEWHERE and step.judged.rows != step.fit.dataset.rows:
        errors = f"held-out error, {_ELSEWHERE[step.judged.rows]},"
        before, after = step.judged.before, step.judged.after
    told = f"{_DONE[step.change]} {step.effect}{instead}: {errors} {before:.2%} to {after:.2%}."
    return told if not step.rivals else f"{told} These trials cannot tell it from {' or '.join(step.rivals)}."
