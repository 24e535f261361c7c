"""The next round of a study that asks for its own trials: pick up what was recorded, and say what to record next."""

from pydantic import Field

from bench.config.configuration import BenchConfiguration
from bench.store import Store
from bench.study.errors import NothingNewError
from bench.study.extend import Extended, extend_study
from bench.study.models.base import StudyModel
from bench.study.stages import ROUND, SUGGESTING
from bench.study.suggestion.rounds import AT_ONCE
from bench.study.suggestion.suggest import suggest
from bench.study.suggestion.suggested import Suggested
from compensator.lab import progress


class NextRound(StudyModel):
    """What was picked up since the last round, and what is to be recorded next."""

    extended: Extended | None = Field(description="null: nothing was recorded for the study since the last round")
    suggested: Suggested


@progress.stages(ROUND)
def next_round(store: Store, study_id: int, configuration: BenchConfiguration, trials: int = AT_ONCE) -> NextRound:
    """Add what was recorded for a study since the last round, and suggest trials by what all of it tells.

    Args:
        store: with the study.
        study_id: which study.
        configuration: of the bench that would run them.
        trials: how many at most.

    Raises:
        NotFoundError, StudyError: as `extend_study` and `suggest`.
    """
    try:
        extended = extend_study(store, study_id)
    except NothingNewError:
        extended = None
    progress.enter(SUGGESTING)
    return NextRound(extended=extended, suggested=suggest(store, study_id, configuration, None, trials))
