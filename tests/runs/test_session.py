"""The time since the session began: a condition of every trial."""

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest

from bench.config.configuration import default_configuration
from bench.runs import session
from bench.runs.runner import Runner
from bench.runs.session import PAGE, Session, session_start
from bench.store import Store

NOW = datetime(2026, 3, 1, 12, tzinfo=UTC)


def experiment(began_min, ended_min, outcome="completed", bench="mine", source="real"):
    """Minutes before now."""
    return SimpleNamespace(
        started_utc=NOW - timedelta(minutes=began_min),
        finished_utc=NOW - timedelta(minutes=ended_min),
        outcome=outcome,
        source=source,
        provenance={"configuration": {"name": bench}},
    )


def begun_before_min(*newest_first):
    store = SimpleNamespace(experiments=lambda limit, offset: list(newest_first[offset : offset + limit]))
    return (NOW - session_start(store, "mine", NOW)).total_seconds() / 60.0


def test_a_session_goes_back_to_the_last_long_pause():
    assert begun_before_min() == 0.0
    assert begun_before_min(experiment(20, 10), experiment(60, 45), experiment(120, 95)) == 60.0
    assert begun_before_min(experiment(50, 40)) == 0.0


def test_what_moved_nothing_or_elsewhere_does_not_count():
    assert begun_before_min(experiment(20, 20, "refused"), experiment(50, 40)) == 0.0
    assert begun_before_min(experiment(20, 10, bench="theirs")) == 0.0
    assert begun_before_min(experiment(20, 10, source="imported")) == 0.0


def test_a_session_may_be_longer_than_a_page():
    many = [experiment(10 * number + 10, 10 * number + 5) for number in range(2 * PAGE)]
    assert begun_before_min(*many) == 20.0 * PAGE


def test_the_walls_time_goes_on_between_trials(monkeypatch):
    now_s = 1000.0
    monkeypatch.setattr(session.time, "monotonic", lambda: now_s)
    walls, virtual = Session(60.0), Session(None)
    now_s += 5.0
    for one in (walls, virtual):
        one.passed(2.0)
    assert (walls.seconds(), virtual.seconds()) == (65.0, 2.0)


def test_every_trial_says_when_in_the_session_it_began(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        runner = Runner(default_configuration(), store)
        for _ in range(2):  # each on a drive that is made anew
            runner.start("steps", {"repeats": 2})
            assert runner.wait(60.0)
        runner.close()
        began_s = [trial.conditions["session_s"] for trial in store.trials()]
        lasted_s = [store.samples(trial.id, ["time_s"])["time_s"][-1] for trial in store.trials()]
    assert began_s == pytest.approx([0.0, lasted_s[0], 0.0, lasted_s[2]], abs=1e-3)
