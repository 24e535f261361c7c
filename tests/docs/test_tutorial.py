"""The lesson on the command line, done as it is written: each command in a process of its own."""

import multiprocessing
import os
import re
import shlex
from pathlib import Path

import pytest

from bench.cli.app import app
from tests.docs.documents import text_of
from tests.paths import ROOT

LESSON = text_of(ROOT / "docs" / "tutorial" / "study.md")
BLOCKS = re.findall(r"```sh\n(.*?)```", LESSON, re.DOTALL)
# imported once, for all commands; these have nearly everything else
MODULES = ["bench.runs.runner", "bench.study.closed_loop", "bench.study.report.report", "bench.study.diagnosis.search"]


def _run(words: list[str], folder: Path, environment: dict[str, str], said: Path) -> None:
    """In a process of its own: run `friction-bench` with these words, and keep what it prints."""
    os.chdir(folder)
    os.environ.update(environment)  # the process that this one is forked from may be older
    with said.open("a") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    app(words)


@pytest.mark.timeout(900)  # a minute or two by itself; a shared machine may take several
def test_the_study_of_the_tutorial(tmp_path: Path) -> None:
    assert len(BLOCKS) == 8
    export, *commands = (shlex.split(line) for line in "".join(BLOCKS).splitlines())
    assert export[0] == "export"
    environment = dict([export[1].split("=")])
    assert {words[0] for words in commands} == {"friction-bench"}
    context, said = multiprocessing.get_context("forkserver"), tmp_path / "said.txt"
    context.set_forkserver_preload(MODULES)
    for words in commands:
        process = context.Process(target=_run, args=(words[1:], tmp_path, environment, said))
        process.start()
        process.join()
        assert process.exitcode == 0, said.read_text()
    assert re.findall(r"^Added (\w+)", said.read_text(), re.MULTILINE) == ["weight_friction"]
    # the search ends with what a diagnosis of the model that it kept says, and so does the last one
    assert len(re.findall(r"^Nothing is missing", said.read_text(), re.MULTILINE)) == 2
    assert (tmp_path / "study-1.html").stat().st_size > 10_000
