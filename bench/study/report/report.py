"""A study as one HTML file that a lab can file: what was measured, the models, what is missing, what to record next."""

from bench.config.configuration import BenchConfiguration
from bench.errors import BenchError
from bench.report import Section, html_page
from bench.store import Store
from bench.study.closed_loop import simulate
from bench.study.compare import compare
from bench.study.create import describe
from bench.study.diagnosis.diagnose import diagnose
from bench.study.ladder import ladder
from bench.study.models.stages import DIAGNOSING, MOVING, REPORT, SUGGESTING
from bench.study.report.diagnosis_sections import diagnosis_section, provenance_section, suggestion_section
from bench.study.report.head_section import head_section
from bench.study.report.model_sections import (
    closed_loop_section,
    ladder_figure,
    ladder_section,
    measured_figure,
    measured_section,
    model_section,
    residual_section,
)
from bench.study.report.wording import in_words
from bench.study.suggestion.suggest import suggest
from compensator.lab import progress


def report_html(store: Store, study_id: int, configuration: BenchConfiguration | None = None) -> str:
    """The report of a study as one HTML page that needs no network.

    Args:
        store: with the study.
        study_id: which study.
        configuration: of the bench, for the trials to record next; None: they are left out.

    Raises:
        NotFoundError: no such study.
        StudyError: its trials cannot be used.
    """
    return html_page(*report(store, study_id, configuration))


@progress.stages(REPORT)
def report(store: Store, study_id: int, configuration: BenchConfiguration | None = None) -> tuple[str, list[Section]]:
    """Title and sections. Arguments and errors as `report_html`."""
    study, rungs = describe(store, study_id), ladder(store, study_id)
    first, newest = study.models[0].model_id, study.model_id
    now = compare(store, study_id, newest)
    before = now if first == newest else compare(store, study_id, first)
    progress.enter(MOVING)
    loop = _in_closed_loop(store, study_id, newest)
    sections = [
        measured_section(study, store),
        ladder_section(rungs),
        model_section(now),
        residual_section(before, now),
        loop,
    ]
    progress.enter(DIAGNOSING)
    if first != newest:
        title = f"What was missing from the first model, {first}"
        sections.append(diagnosis_section(title, diagnose(store, study_id, first), before))
    last = diagnose(store, study_id)
    pictures = [ladder_figure(rungs), measured_figure(before, now)]
    sections.insert(0, head_section(study, rungs, last.sentence, store, pictures))
    sections.append(diagnosis_section(f"What is missing from the newest model, {newest}", last, now))
    progress.enter(SUGGESTING)
    if configuration is not None:
        sections.append(_next(store, study_id, configuration))
    sections.append(provenance_section(study, store))
    return f"Study {study_id}: {study.name}", in_words(sections, [one.name for one in study.trials])


def _next(store: Store, study_id: int, configuration: BenchConfiguration) -> Section:
    """Trials to record next; why there are none where this bench cannot tell."""
    try:
        found = suggest(store, study_id, configuration)
    except BenchError as error:
        return Section("Trials to record next", [f"Not known: {error}."])
    return suggestion_section(found)


def _in_closed_loop(store: Store, study_id: int, model_id: int) -> Section:
    """Where the model's joint goes; why nobody knows where it cannot be moved."""
    try:
        found = simulate(store, study_id, model_id)
    except BenchError as error:
        return Section("In closed loop", [f"Not known: {error}."])
    return closed_loop_section(found)
