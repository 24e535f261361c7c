"""The next round of a study that asks for its own trials: pick up what was recorded, and say what to record next."""

from bench.config.configuration import BenchConfiguration
from bench.store import Store
from bench.study.errors import NothingNewError
from bench.study.extend import extend_study
from bench.study.models.stages import ROUND, SUGGESTING
from bench.study.suggestion.rounds import AT_ONCE
from bench.study.suggestion.suggest import suggest
from bench.study.suggestion.suggested import NextRound
from compensator.lab import progress


@progress.stages(ROUND)
def next_round(store: Store, study_id: int, configuration: BenchConfiguration, trials: int = AT_ONCE) -> NextRound:
    """Add what was recorded for a study since the last round, and suggest trials by what all of it tells.

    Raises:
        NotFoundError, StudyError: as `extend_study` and `suggest`.
    """
    try:
        extended = extend_study(store, study_id)
    except NothingNewError:
        extended = None
    progress.enter(SUGGESTING)
    return NextRound(extended=extended, suggested=suggest(store, study_id, configuration, None, trials))
