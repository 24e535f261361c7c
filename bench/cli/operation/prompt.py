"""What the bench asks its person for, on the terminal: shown once, answered with Enter."""

import select
import sys
from typing import TYPE_CHECKING

import typer

from bench.errors import PromptError

if TYPE_CHECKING:
    from bench.control.prompt import Prompt
    from bench.runs.runner import Runner

_POLL_S = 0.1


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
