"""Diagnoses of many studies: on all cores, or on a cluster whose workers need neither the store nor its disk."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from bench.parallel.over_cores import over_cores
from bench.store import Store
from bench.store.records import ModelRow
from bench.study.diagnosis.diagnose import answer_of, explained_by
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.errors import StudyError, lab_errors
from bench.study.joint import joint_of
from bench.study.material import Definition, Material, model_of, trials_of
from bench.study.models.diagnosis import Diagnosis, Joint, NotDiagnosed
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing

Shown = Callable[[int, int], None]
"""Called with (studies done, studies in all) as answers come."""


@dataclass(frozen=True)
class Question:
    """All that a diagnosis depends on, wherever it is made."""

    study_id: int
    model: ModelRow
    definition: Definition
    recordings: list[Recording]
    explained: float  # by effects that were added, see `answer_of`
    joint: Joint


def diagnose_many(
    store: Store, study_ids: Sequence[int], shown: Shown, workers: int | None = None, cluster: str | None = None
) -> list[Diagnosis | NotDiagnosed]:
    """The diagnosis of the newest model of each study, as `diagnose` gives it, in the order given.

    A study that cannot be judged has a `NotDiagnosed` in place of an answer.

    Args:
        store: with the studies.
        study_ids: which.
        shown: told of the progress.
        workers: processes; None takes all cores, 0 and 1 work in this one.
        cluster: address of a Dask scheduler, whose workers are used instead.

    Raises:
        NotFoundError: no such study, or one of its trials is gone.
        ClusterError: the cluster cannot be used.
    """
    found = []
    shown(0, len(study_ids))
    questions = _questions(store, study_ids)
    for answer in over_cores(answer_to, questions, 1 if len(study_ids) < 2 else workers, cluster):
        found.append(answer)
        shown(len(found), len(study_ids))
    return found


def answer_to(question: Question) -> Diagnosis | NotDiagnosed:
    """Diagnose, in whatever process this is."""
    definition, model = question.definition, question.model
    try:
        with lab_errors():
            dataset = make_dataset(
                question.recordings, definition.facts, Processing(definition.cutoff_hz, definition.rows)
            )
        material = Material(question.study_id, "", definition, (), dataset)
        fit = material.fit_of(model)
        found = diagnosis_of_model(material, model, fit)
        return answer_of(fit, found, question.study_id, model.id, question.explained, question.joint)
    except StudyError as error:
        return NotDiagnosed(study_id=question.study_id, model_id=model.id, error=str(error))


def _questions(store: Store, study_ids: Sequence[int]) -> Iterator[Question]:
    """One after the other, so that only those under way are in memory."""
    for study_id in study_ids:
        model = model_of(store, study_id, None)
        definition = trials_of(model, Definition.from_json(store.study(study_id).definition))
        recordings = [store.recording(trial) for trial in definition.trial_ids]
        joint = joint_of(store, definition)
        yield Question(study_id, model, definition, recordings, explained_by(store, model), joint)
