"""The report of trials in which the joint was pushed and never slid: no model, but what they bound."""

from collections.abc import Sequence

from bench.config.rig import Rig
from bench.report import Figure, Line, Section, html_page
from bench.store import Store
from bench.study.errors import StudyError
from bench.study.material import facts_of
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.recording import Recording

MOST_TRIALS, MOST_POINTS = 6, 500  # of the picture


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
