"""How long the joint has been in use: what warmth and running-in go by, recorded with every trial as `session_s`."""

import time
from datetime import UTC, datetime, timedelta

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import is_simulated
from bench.store import Store

CONDITION = "session_s"
GAP = timedelta(minutes=30)  # of standing still, after which a joint counts as cold: the next session
PAGE = 20


class Session:
    """Time since the first experiment of the session.

    A simulated drive in this process is made anew, cold, for each experiment, and its time passes in trials alone. On
    any other the wall's time counts, from experiment to experiment.

    Args:
        before_s: since the start of the session, now; None where time passes in trials alone.
    """

    def __init__(self, before_s: float | None) -> None:
        self._start_s = None if before_s is None else time.monotonic() - before_s
        self._trials_s = 0.0

    def seconds(self) -> float:
        """Since its start, to the millisecond [s]."""
        return round(self._trials_s if self._start_s is None else time.monotonic() - self._start_s, 3)

    def passed(self, trial_s: float) -> None:
        """A trial of that length has been run."""
        self._trials_s += trial_s


def session_of(configuration: BenchConfiguration, store: Store) -> Session:
    """The session that an experiment beginning now belongs to."""
    if is_simulated(configuration):
        return Session(None)
    now = datetime.now(UTC)
    return Session(max(0.0, (now - session_start(store, configuration.name, now)).total_seconds()))


def session_start(store: Store, bench: str, now: datetime) -> datetime:
    """When the first of the experiments began that followed each other without a longer pause, up to now.

    Those that moved nothing, and those of other benches, do not count.
    """
    start, offset = now, 0
    while found := store.experiments(limit=PAGE, offset=offset):
        for one in found:
            of_bench = one.provenance.get("configuration", {}).get("name") == bench
            if one.source == "imported" or not of_bench or one.outcome in ("running", "refused"):
                continue
            if start - (one.finished_utc or one.started_utc) > GAP:
                return start
            start = min(start, one.started_utc)
        offset += PAGE
    return start
