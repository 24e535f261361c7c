"""What the person at the bench is asked, on the terminal."""

import os
import sys
import threading

import pytest

from bench.cli.operation.watch import attend
from bench.control.prompt import PromptDesk


class Asking:
    """A runner that asks one question and notes how it was stopped."""

    def __init__(self):
        self._desk, self._stopped = PromptDesk(), threading.Event()
        self.answered, self.reason = None, ""
        self._thread = threading.Thread(target=self._ask)
        self._thread.start()
        while self._desk.pending is None:
            pass

    def _ask(self):
        self.answered = self._desk.ask("Hang 50 g.", self._stopped.is_set)

    def status(self):
        return self

    @property
    def prompt(self):
        return self._desk.pending

    def answer(self, number):
        self._desk.answer(number)

    def stop(self, reason):
        self.reason = reason
        self._stopped.set()

    def join(self):
        self._thread.join(10.0)


@pytest.fixture
def keyboard(monkeypatch):
    """The writing end of a pipe that is the command's input."""
    reading, writing = os.pipe()
    with os.fdopen(reading) as stdin, os.fdopen(writing, "w") as end:
        monkeypatch.setattr(sys, "stdin", stdin)
        yield end


def test_enter_goes_on(keyboard, capsys):
    runner = Asking()
    keyboard.write("\n")
    keyboard.flush()
    attend(runner)
    runner.join()
    assert runner.answered
    assert capsys.readouterr().err == "Hang 50 g. Then press Enter (Ctrl-C stops). "


def test_a_closed_input_stops(keyboard):
    runner = Asking()
    keyboard.close()
    attend(runner)
    runner.join()
    assert (runner.answered, runner.reason) == (False, "nobody could be asked: the input of the command is closed")


def test_a_stop_ends_the_waiting(keyboard):
    runner = Asking()
    stopping = threading.Timer(0.3, runner.stop, ["STOP on the page"])
    stopping.start()
    attend(runner)
    runner.join()
    assert (runner.answered, runner.reason) == (False, "STOP on the page")
