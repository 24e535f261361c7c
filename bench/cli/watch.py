"""Watching a run: a progress bar on a terminal, plain lines elsewhere."""

from typing import TYPE_CHECKING

from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from bench.cli.output import console, say
from bench.cli.prompt import attend

if TYPE_CHECKING:
    from bench.runner import Runner, RunnerStatus

_POLL_S = 0.1


def watch(runner: "Runner", quiet: bool) -> None:
    """Return when the experiment has ended.

    Args:
        runner: has been started.
        quiet: show nothing.
    """
    if quiet:
        while not runner.wait(_POLL_S):
            attend(runner)
    elif console().is_terminal:
        _bar(runner)
    else:
        _lines(runner)


def _bar(runner: "Runner") -> None:
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
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
