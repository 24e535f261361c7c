"""The live stream goes on where it was left, with the control loop in a process of its own, also after its death."""

import os
import signal
from collections.abc import Iterator

import pytest

from tests.queue.waiting import wait_for
from tests.service.listening import hear, left_at, listen, of_run, recorded, rows_of, times, until
from tests.service.running_service import RunningService, running_service

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("live"), in_process_of_its_own=True) as running:
        yield running


def test_nothing_is_missed_over_a_broken_connection(idle):
    running = idle.start("steps", pace="real-time", repeats=1)
    first = hear(idle, running, 100)
    hear(idle, running, len(of_run(idle, running, first)) + 100)  # time passes
    rest = hear(idle, running, 200, left_at(first))
    idle.client.post("/stop")
    assert idle.runner.wait(20.0)
    heard = of_run(idle, running, first) + rows_of(rest)
    assert heard == recorded(idle, running)[: len(heard)]
    assert "gap" not in {name for name, _, _ in rest}


def test_nothing_that_is_recorded_is_missed_over_the_death_of_the_bench_process(idle):
    killed = idle.start("steps", pace="real-time", repeats=1)
    first = hear(idle, killed, 100)
    os.kill(idle.runner._supervisor.child().process_id, signal.SIGKILL)
    assert idle.runner.wait(60.0)
    wait_for(lambda: idle.store.experiment(killed).outcome == "interrupted")
    following = idle.start("steps", pace="real-time", repeats=1)
    hear(idle, following, 0)
    wanted = [row for row in recorded(idle, killed) if row not in set(rows_of(first))]
    rest = until(listen(idle.url, left_at(first)), lambda found: len(times(found)) > len(wanted) + 50)
    idle.client.post("/stop")
    assert idle.runner.wait(20.0)
    heard = rows_of(rest)
    assert heard[: len(wanted)] == wanted
    new = recorded(idle, following)
    assert heard[len(wanted) :] == new[: len(heard) - len(wanted)]
