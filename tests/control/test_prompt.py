"""What a person at the bench is asked: answered once, by its number, and never in the way of a stop."""

import threading
import time

import pytest

from bench.config.configuration import default_configuration
from bench.control import station
from bench.control.drive_factory import Equipment
from bench.control.prompt import PromptDesk
from bench.control.technician import PersonTechnician
from bench.errors import PromptError
from bench.runs.runner import Runner
from bench.store import Store
from tests.control.fake_drive import FakeDrive


def wait_for(condition, timeout_s=20.0):
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline_s, "waited in vain"
        time.sleep(0.005)


@pytest.fixture
def bench(monkeypatch, tmp_path):
    """A runner whose drive is the fake one, and whose loads are hung by a person."""
    drive = FakeDrive()
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, ask: Equipment(drive, PersonTechnician(ask)))
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        runner = Runner(default_configuration(), store)
        yield runner, drive, store
        runner.close()


def test_the_run_waits_for_its_answer_with_the_power_off(bench):
    runner, drive, _ = bench
    runner.start("load-sweep", {"loads_kg": [0.0, 0.01], "angles_rad": [0.0], "searches": 1})
    wait_for(lambda: runner.status().prompt)
    prompt = runner.status().prompt
    assert prompt.sentence == "Take every load off the arm, and stand clear."
    assert (drive.exchanges, drive.powered) == (0, False)
    runner.answer(prompt.number)
    wait_for(lambda: runner.status().prompt not in (None, prompt))
    assert runner.status().prompt.sentence == "Hang 10 g at the tip of the arm, and stand clear."
    assert drive.exchanges > 0
    assert not drive.powered


def test_a_stop_while_it_waits_ends_the_run_as_stopped(bench):
    runner, drive, store = bench
    experiment_id = runner.start("steps", {"repeats": 1})
    wait_for(lambda: runner.status().prompt)
    runner.stop("lunch")
    assert runner.wait(10.0)
    experiment = store.experiment(experiment_id)
    assert (experiment.outcome, experiment.reason) == ("stopped", "lunch")
    assert (drive.exchanges, drive.calls[-1], runner.status().prompt) == (0, "close", None)


def test_an_answer_that_comes_late_does_not_count_for_the_next_question():
    desk, answers = PromptDesk(), []
    with pytest.raises(PromptError, match="nothing is asked now"):
        desk.answer(1)
    asker = threading.Thread(
        target=lambda: answers.extend(desk.ask(sentence, lambda: False) for sentence in ("First.", "Second."))
    )
    asker.start()
    wait_for(lambda: desk.pending)
    desk.answer(1)
    wait_for(lambda: desk.pending and desk.pending.number == 2)
    with pytest.raises(PromptError, match="prompt 1 is not open, prompt 2 is: Second"):
        desk.answer(1)
    desk.answer(2)
    asker.join(10.0)
    assert answers == [True, True]
