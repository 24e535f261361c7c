"""A study as one HTML file that a lab can file: what was measured, the models, what is missing, what to record next."""

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime

from bench.config.configuration import BenchConfiguration
from bench.errors import BenchError
from bench.provenance import software
from bench.report import Figure, Section, Table, html_page
from bench.store import Store
from bench.store.records import Experiment
from bench.study.closed_loop import simulate
from bench.study.compare import compare
from bench.study.create import describe
from bench.study.diagnosis.diagnose import diagnose
from bench.study.diagnosis.last_words import last_words, listed, share_left
from bench.study.ladder import ladder
from bench.study.models.comparison import Comparison
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.ladder import Ladder, Rung
from bench.study.models.stages import DIAGNOSING, MOVING, REPORT, SUGGESTING
from bench.study.models.study import Study
from bench.study.report.diagnosis_sections import diagnosis_section, provenance_section, suggestion_section
from bench.study.report.model_sections import (
    closed_loop_section,
    judged_there,
    ladder_figure,
    ladder_section,
    measured_figure,
    measured_section,
    model_section,
    percent,
    residual_section,
)
from bench.study.report.wording import in_words
from bench.study.suggestion.suggest import suggest
from compensator.lab import progress

NOT_TOLD = "not told"
LEAST_FALL = 0.05  # of an error that counts steady sliding, for which an effect near reversals is given the credit
_JUDGED_BY = {
    "leave-one-trial-out": "each of which was left out in turn to judge the model",
    "leave-one-block-out": "too few to leave one out; stretches of 2 s were left out instead",
}


def head_section(
    study: Study, rungs: Ladder, diagnosis: str, store: Store, pictures: Sequence[Figure], confused: Sequence[str] = ()
) -> Section:
    """What whoever files the report looks for first."""
    numbers = dict.fromkeys(store.trial(one.trial_id).experiment_id for one in study.trials)
    experiments = [store.experiment(number) for number in numbers]
    now = software()
    drives = [one.provenance.get("drive") or {} for one in experiments]
    facts = [
        ("date", datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")),
        ("recorded", _days(experiments)),
        ("operator", _joined(one.operator for one in experiments)),
        ("rig", _joined(str(one.rig.get("name", "")) for one in experiments)),
        ("drive", _joined(" ".join(str(d[k]) for k in ("vendor", "product", "firmware") if d.get(k)) for d in drives)),
        ("source", _joined(one.source for one in experiments)),
        ("version", str(now.get("version") or NOT_TOLD)),
        ("commit", str(now.get("commit") or NOT_TOLD)),
    ]
    return Section("In short", summary(study, rungs, diagnosis, confused), [Table("Head", ["", ""], facts)], pictures)


def summary(study: Study, rungs: Ladder, diagnosis: str, confused: Sequence[str] = ()) -> list[str]:
    """What was measured, what the model is off by, what in it could be another name, what it lacks."""
    held = sum(one.role == "held_out" for one in study.trials)
    first, last = rungs.rungs[0], rungs.rungs[-1]
    elsewhere = _shown_elsewhere(rungs)
    uncounted = [name for name in added_in(rungs) if name in elsewhere]
    added = [name for name in added_in(rungs) if name not in elsewhere]
    error = f"{percent(last.held_out)} ({percent(last.held_out_low)} .. {percent(last.held_out_high)})"
    if added:
        off = f"With {listed(added)} the error goes from {percent(first.held_out)} to {error} of the effort"
    else:
        off = f"The model is off by {error} of the effort"
    many = f"{len(study.trials)} trial{'s' if len(study.trials) != 1 else ''}"
    judged = f"of which {held} judge the model" if held else _JUDGED_BY.get(last.held_out_kind, "")
    return [
        f"{many} {'were' if len(study.trials) != 1 else 'was'} measured{f', {judged}' if judged else ''}.",
        f"{off}, on {'stretches' if 'block' in last.held_out_kind else 'trials'} that it was not fitted to.",
        *(_added_elsewhere(name, elsewhere[name]) for name in uncounted),
        *confused,
        diagnosis,
    ]


def _shown_elsewhere(rungs: Ladder) -> dict[str, Rung]:
    """Steps that added what the errors of the ladder do not tell of: neither by their rows nor by a fall."""
    before = {one.model_id: one.held_out for one in rungs.rungs}
    return {
        (one.added or "").replace("_", " "): one
        for one in rungs.rungs
        if one.shows and not one.held_out < (1.0 - LEAST_FALL) * before.get(one.parent_id or 0, one.held_out)
    }


def _added_elsewhere(name: str, rung: Rung) -> str:
    """Of an effect that the errors of the ladder do not tell of."""
    shows = f"{name[:1].upper()}{name[1:]} was added, too: it shows {rung.shows}, which this error does not count"
    return f"{shows}{judged_there(rung).replace(':', ';', 1)}."


def _days(experiments: Iterable[Experiment]) -> str:
    days = sorted({one.started_utc.date().isoformat() for one in experiments})
    return days[0] if len(days) == 1 else f"{days[0]} .. {days[-1]}"


def _joined(values: Iterable[str]) -> str:
    return ", ".join(dict.fromkeys(value for value in values if value)) or NOT_TOLD


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
        sections.append(_missing(f"What was missing from the first model, {first}", store, before)[1])
    title = f"What is missing from the newest model, {newest}"
    sentence, last = _missing(title, store, now, rungs)
    pictures = [ladder_figure(rungs), measured_figure(before, now)]
    sections = [head_section(study, rungs, sentence, store, pictures), *sections, last]
    progress.enter(SUGGESTING)
    if configuration is not None:
        sections.append(_next(store, study_id, configuration))
    sections.append(provenance_section(study, store))
    return f"Study {study_id}: {study.name}", in_words(sections, [one.name for one in study.trials])


def added_in(rungs: Ladder) -> list[str]:
    """Effects that the last model has and the first one had not, as they are shown."""
    first, last = rungs.rungs[0], rungs.rungs[-1]
    return [name.replace("_", " ") for name in last.effects if name not in first.effects]


def left_in_words(found: Diagnosis, rungs: Ladder) -> str:
    """What the last model of a ladder lacks, beside what was added to the first one."""
    first, last = rungs.rungs[0], rungs.rungs[-1]
    return last_words(found, added_in(rungs), share_left(first.held_out, last.held_out))


def _missing(title: str, store: Store, compared: Comparison, rungs: Ladder | None = None) -> tuple[str, Section]:
    """What a model lacks, in a sentence and as a section; why nobody can tell where these trials show nothing."""
    try:
        found = diagnose(store, compared.study_id, compared.model_id)
    except BenchError as error:
        why = f"What is missing cannot be judged: {error}."
        return why, Section(title, [why])
    return found.sentence if rungs is None else left_in_words(found, rungs), diagnosis_section(title, found, compared)


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
