"""The live stream goes on where it was left, with the control loop in a process of its own, also after its death."""

import os
import signal
from collections.abc import Iterator

import pytest

from tests.queue.waiting import wait_for
from tests.service.running_service import RunningService, running_service
from tests.service.test_live import listen, times, until

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("live"), in_process_of_its_own=True) as running:
        yield running


def rows_of(events) -> list[tuple[int, float]]:
    """(trial, time) of each row."""
    return [(data["trial_id"], row[0]) for name, _, data in events if name == "rows" for row in data["rows"]]


def left_at(events) -> str:
    return [number for name, number, _ in events if name == "rows"][-1]


def recorded(service: RunningService, experiment_id: int) -> list[tuple[int, float]]:
    trials = service.store.trials(experiment_id)
    return [(trial.id, time_s) for trial in trials for time_s in service.store.samples(trial.id)["time_s"].tolist()]


def test_nothing_is_missed_over_a_broken_connection(idle):
    experiment_id = idle.start("steps", pace="real-time", repeats=1)
    first = until(listen(idle.url), lambda found: len(times(found)) > 100)
    until(listen(idle.url), lambda found: len(times(found)) > len(times(first)) + 100)  # time passes
    rest = until(listen(idle.url, left_at(first)), lambda found: len(times(found)) > 200)
    idle.client.post("/stop")
    assert idle.runner.wait(20.0)
    heard = rows_of(first) + rows_of(rest)
    assert heard == recorded(idle, experiment_id)[: len(heard)]
    assert "gap" not in {name for name, _, _ in rest}


def test_nothing_that_is_recorded_is_missed_over_the_death_of_the_bench_process(idle):
    killed = idle.start("steps", pace="real-time", repeats=1)
    first = until(listen(idle.url), lambda found: len(times(found)) > 100)
    os.kill(idle.runner._supervisor.child().process_id, signal.SIGKILL)
    assert idle.runner.wait(60.0)
    wait_for(lambda: idle.store.experiment(killed).outcome == "interrupted")
    following = idle.start("steps", pace="real-time", repeats=1)
    begun = until(listen(idle.url), lambda found: {following} & {trial_of(idle, one) for one in rows_of(found)[-1:]})
    assert begun
    wanted = [row for row in recorded(idle, killed) if row not in set(rows_of(first))]
    rest = until(listen(idle.url, left_at(first)), lambda found: len(times(found)) > len(wanted) + 50)
    idle.client.post("/stop")
    assert idle.runner.wait(20.0)
    heard = rows_of(rest)
    assert heard[: len(wanted)] == wanted
    new = recorded(idle, following)
    assert heard[len(wanted) :] == new[: len(heard) - len(wanted)]


def trial_of(service: RunningService, row: tuple[int, float]) -> int:
    """The experiment that a row is of."""
    return service.store.trial(row[0]).experiment_id
