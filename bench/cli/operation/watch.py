"""Watching a run: a progress bar on a terminal, plain lines elsewhere."""

import select
import sys
from typing import TYPE_CHECKING

import typer
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from bench.cli.output import console, say
from bench.errors import PromptError

if TYPE_CHECKING:
    from bench.control.prompt import Prompt
    from bench.runs.bench_control import RunnerStatus
    from bench.runs.runner import Runner

_POLL_S = 0.1
_SOON_S = 0.01


def attend(runner: "Runner") -> None:
    """Where something is asked, show it and wait for Enter, or until nobody waits for it any more.

    The question goes to stderr: stdout may be read by a program.
    """
    prompt = runner.status().prompt
    if prompt is None:
        return
    typer.echo(f"{prompt.sentence} Then press Enter (Ctrl-C stops). ", err=True, nl=False)
    while _is_open(runner, prompt):
        if not _is_readable():
            continue
        if not sys.stdin.readline():
            runner.stop("nobody could be asked: the input of the command is closed")
            return
        try:
            runner.answer(prompt.number)
        except PromptError:  # stopped while the key went down
            return


def _is_open(runner: "Runner", prompt: "Prompt") -> bool:
    now = runner.status().prompt
    return now is not None and now.number == prompt.number


def _is_readable() -> bool:
    """Whether a line (or the end of the input) waits; looked at in turns, so that a stop is noticed."""
    return bool(select.select([sys.stdin], [], [], _POLL_S)[0])


def watch(runner: "Runner", quiet: bool) -> None:
    """Return when the experiment has ended."""
    if not quiet:
        _announce(runner)
    if quiet:
        while not runner.wait(_POLL_S):
            attend(runner)
    elif console().is_terminal:
        _bar(runner)
    else:
        _lines(runner)


def _announce(runner: "Runner") -> None:
    """How many trials are to come, and how long they take."""
    while not runner.status().trial_count and not runner.wait(_SOON_S):
        continue
    found = runner.status()
    say(f"{found.kind}: {found.trial_count} trials, about {found.duration_s:.0f} s of the joint's time")


def _bar(runner: "Runner") -> None:
    times = (TimeElapsedColumn(), TimeRemainingColumn())
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), *times)
    with Progress(*columns, console=console()) as progress:
        task = progress.add_task("starting", total=1.0)
        ended = False
        while not ended:
            ended = runner.wait(_POLL_S)
            status = runner.status()
            if status.prompt is not None:
                progress.stop()  # it draws over what is asked
                attend(runner)
                progress.start()
            progress.update(task, description=_sentence(status), completed=status.progress)


def _lines(runner: "Runner") -> None:
    shown = ""
    ended = False
    while not ended:
        ended = runner.wait(_POLL_S)
        sentence = _sentence(runner.status())
        if sentence != shown:
            say(sentence)
        shown = sentence
        attend(runner)


def _sentence(status: "RunnerStatus") -> str:
    return f"{status.kind}: trial {status.trial_index + 1} of {status.trial_count}"
