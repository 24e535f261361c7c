"""From an experiment to a report for a colleague, in one go: base model, comparison, search, what to record next."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bench.config.rig import Rig
from bench.report import Figure, Line, Section, html_page
from bench.store import Store
from bench.study.changes import add_effect
from bench.study.compare import compare
from bench.study.create import create_study, describe
from bench.study.diagnosis.diagnose import diagnose
from bench.study.diagnosis.search import search_and_diagnose
from bench.study.errors import StudyError
from bench.study.explanation.coverage import coverage
from bench.study.ladder import ladder
from bench.study.material import facts_of, model_of
from bench.study.models.change import SearchStep
from bench.study.models.comparison import Comparison
from bench.study.models.coverage import Coverage
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.ladder import Ladder
from bench.study.report.coverage_section import advice_section, coverage_section
from bench.study.report.diagnosis_sections import diagnosis_section, provenance_section
from bench.study.report.model_sections import (
    ladder_figure,
    ladder_section,
    measured_figure,
    measured_section,
    model_section,
    residual_section,
    worst_trial,
)
from bench.study.report.report import head_section, left_in_words, summary
from bench.study.report.wording import in_words
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.errors import NeverSlidesError
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.recording import Recording

MOST_TRIALS, MOST_POINTS = 6, 500  # of the picture
MOST_CURVES = 2  # without physics: more would be a table of the recordings, and no explanation
LEAST_GAIN = 0.02  # of the held-out error: for less nobody would read six more numbers
STEPS = ("base model", "what the data can tell", "comparison", "diagnosis", "search", "report")
Tell = Callable[[str, int], None]


class NeverSlidError(StudyError):
    """Raised when no model can be made, since the joint never slid; `html` is a report all the same."""

    def __init__(self, sentence: str, html: str) -> None:
        super().__init__(sentence)
        self.html = html


def never_slid_page(store: Store, experiment_id: int, name: str, sentence: str, came_in: Section | None = None) -> str:
    """One HTML page."""
    recordings = [store.recording(trial.id) for trial in store.trials(experiment_id)]
    facts = facts_of(Rig.model_validate(store.experiment(experiment_id).rig))
    told = Section("In short", [sentence], figures=[_loops(recordings, choose_effort(recordings, facts), facts)])
    return html_page(f"What holds {name}", [told, *([came_in] if came_in else [])])


def _loops(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> Figure:
    """Effort over position of the first trials: a spring's line, or the loop that friction makes of it."""
    lines = []
    for one in recordings[:MOST_TRIALS]:
        step = max(1, len(one) // MOST_POINTS)
        position = one.channels[f"position_{facts.position_unit}"][::step]
        lines.append(Line(one.name, position.tolist(), effort.of(one)[::step].tolist()))
    title = f"{effort.title} [{effort.unit}]"
    return Figure("Effort over position", f"position [{facts.position_unit}]", title, lines)


@dataclass(frozen=True)
class Explained:
    """What came of it.

    Attributes:
        study_id: of the study that was made.
        sentences: what was measured, what was missing, what is left.
        coverage: what the trials can and cannot tell.
        not_judged: effects that the last diagnosis could not judge on these trials; the report says why.
        html: the report, as one page that needs no network.
    """

    study_id: int
    sentences: tuple[str, ...]
    rungs: Ladder
    coverage: Coverage
    not_judged: tuple[str, ...]
    html: str

    def as_json(self) -> dict[str, object]:
        """All but the page."""
        return {
            "study_id": self.study_id,
            "sentences": list(self.sentences),
            "ladder": self.rungs.model_dump(mode="json"),
            "coverage": self.coverage.model_dump(mode="json"),
            "not_judged": list(self.not_judged),
        }


def explain(
    store: Store,
    experiment_id: int,
    name: str,
    tell: Tell,
    hold_out: Sequence[str] = (),
    came_in: Section | None = None,
) -> Explained:
    """Study an experiment until nothing is missing that its trials can show.

    Args:
        store: with the experiment.
        experiment_id: which one.
        name: of the study.
        tell: called with the name and number of each step as it begins.
        hold_out: criteria `key=value` of the trials that judge; without any, each is left out in turn.
        came_in: how the files were read, as a section of the report.

    Raises:
        StudyError: the trials cannot be used.
        NeverSlidError: the joint was pushed and never slid; it brings a report of what that tells.
    """
    tell(STEPS[0], 0)
    try:
        study_id = create_study(store, name, [experiment_id], hold_out).study_id
    except StudyError as error:
        if not isinstance(error.__cause__, NeverSlidesError):
            raise
        html = never_slid_page(store, experiment_id, name, str(error), came_in)
        raise NeverSlidError(str(error), html) from error
    first = describe(store, study_id).model_id
    tell(STEPS[1], 1)
    told = coverage(store, study_id, first)
    tell(STEPS[2], 2)
    before = compare(store, study_id, first)
    tell(STEPS[3], 3)
    missing = diagnose(store, study_id, first)
    tell(STEPS[4], 4)
    model_id, last, confused = _searched(store, study_id, first)
    tell(STEPS[5], 5)
    now = before if model_id == first else compare(store, study_id, model_id)
    rungs = ladder(store, study_id)
    study = describe(store, study_id)
    pictures = [ladder_figure(rungs), measured_figure(before, now)]
    left = left_in_words(last, rungs)
    head = head_section(study, rungs, left, store, pictures, confused)
    sections = [
        measured_section(study, store),
        coverage_section(told),
        ladder_section(rungs),
        _before_and_after(before, now),
        diagnosis_section("What was missing from the first model", missing, before),
        *([diagnosis_section("What is left", last, now)] if model_id != first else []),
        residual_section(before, now),
        model_section(now),
        *([advice_section(told, _separating(missing, last))] if last.joint != "nowhere" else []),
        provenance_section(study, store),
    ]
    head, *rest = in_words([head, *sections], [one.name for one in study.trials])
    return Explained(
        study_id=study_id,
        sentences=tuple(summary(study, rungs, left, confused)),
        rungs=rungs,
        coverage=told,
        not_judged=tuple(str(one.values["effect"]) for one in last.findings if one.code == "not-judged"),
        html=html_page(f"What the model of {name} lacks", [head, *([came_in] if came_in else []), *rest]),
    )


def _searched(store: Store, study_id: int, first: int) -> tuple[int, Diagnosis, list[str]]:
    """The last model of a search, what it lacks, and which of its effects could as well be others, in sentences.

    Where no formula follows what is missing, a free curve fills the gap, if it predicts other trials better for sure;
    then the search goes on beside it: what the curve cannot be, as what differs by direction, shows only then.
    """
    found, last = search_and_diagnose(store, study_id, first)
    steps = [*found.steps]
    for _ in range(MOST_CURVES):
        curve = last.provisional
        if curve is None or curve.gain_low <= 0.0 or curve.gain < LEAST_GAIN:
            break
        filled = add_effect(store, study_id, curve.effect, last.model_id)
        found, last = search_and_diagnose(store, study_id, filled.model_id)
        steps += found.steps
    kept = model_of(store, study_id, found.model_id).effects
    added = {one.effect: one for one in steps if one.rivals and one.effect in kept}
    return found.model_id, last, [_confused(one) for one in added.values()]


def _confused(step: SearchStep) -> str:
    title, *others = (effect_named(name).in_sentence for name in (step.effect, *step.rivals))
    return f"The {title} that was added may as well be {' or '.join(others)}: these trials cannot tell them apart."


def _separating(*found: Diagnosis) -> list[str]:
    """What would tell effects apart that were named together."""
    trials = [one.separating_trial for diagnosis in found for one in diagnosis.classes if len(one.effects) > 1]
    return list(dict.fromkeys(trial for trial in trials if trial))


def _before_and_after(before: Comparison, now: Comparison) -> Section:
    """What the first and the last model leave, in the trial that the first one is worst in."""
    worst = worst_trial(before)
    old, new = (next(s for s in one.series if s.trial_id == worst.trial_id) for one in (before, now))
    left = [Line("first model", old.time_s, old.residual)]
    if now.model_id != before.model_id:
        left.append(Line("last model", new.time_s, new.residual))
    unit = f"{now.effort.name} [{now.effort.unit}]"
    return Section(
        "Before and after",
        [f"Trial {worst.name}: of all trials the one in which the first model is worst."],
        figures=[Figure("What the models leave", "time [s]", unit, left)],
    )
